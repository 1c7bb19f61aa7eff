// Scenes and settings.
#include "arguments.hpp"

namespace mbs::python {

std::string type_name(const py::object& type) { return type.attr("__name__").cast<std::string>(); }

namespace {

/// What `work` raises, as Refused.
template <class Work>
std::string text_of(Work work) {
  try {
    return as<std::string>("scene", work());
  } catch (const py::error_already_set& error) {
    throw Refused("scene: " + py::str(error.value()).cast<std::string>());
  }
}

/// Numpy's arrays and numbers, for json.dumps().
py::object plain(const py::object& value) {
  if (py::hasattr(value, "tolist")) return value.attr("tolist")();
  throw py::type_error("found " + type_name(py::type::of(value)) +
                       ", allowed is what JSON has, and numpy's arrays and numbers");
}

}  // namespace

SceneDocument scene_of(const py::object& source, const std::string& name) {
  if (py::isinstance<SceneDocument>(source)) return source.cast<SceneDocument>();
  if (py::isinstance<py::dict>(source)) {
    const auto dumps = py::module_::import("json").attr("dumps");
    return SceneDocument::parse(
        text_of([&] { return dumps(source, py::arg("default") = py::cpp_function(plain)); }), name);
  }
  const auto path = py::module_::import("os").attr("fspath");
  return SceneDocument::load(text_of([&] { return path(source); }));
}

std::vector<SceneDocument> scenes_of(const py::object& sources) {
  const bool is_one = py::isinstance<SceneDocument>(sources) || py::isinstance<py::dict>(sources) ||
                      py::isinstance<py::str>(sources);
  if (is_one || !py::isinstance<py::iterable>(sources))
    throw Refused("scenes: found " + type_name(py::type::of(sources)) +
                  ", allowed is a list of scenes");
  std::vector<SceneDocument> scenes;
  for (const py::handle one : sources)
    scenes.push_back(scene_of(py::reinterpret_borrow<py::object>(one), "scene"));
  if (scenes.empty()) throw Refused("scenes: found none, allowed is one or more");
  return scenes;
}

StepperOptions options_of(const py::object& implementation, const py::kwargs& given) {
  StepperOptions options{as<std::string>("implementation", implementation)};
  std::string names;
  py::ssize_t taken = 0;
  const auto take = [&]<class Value>(const char* name, Value& setting) {
    names += std::string(names.empty() ? "" : ", ") + name;
    if (!given.contains(name)) return;
    setting = as<Value>(name, given[name]);
    ++taken;
  };
  StepSettings& settings = options.settings;
  take("step", settings.step);
  take("penalty", settings.penalty);
  take("tolerance", settings.tolerance);
  take("max_passes", settings.max_passes);
  take("scheme", settings.scheme);
  take("multipliers", settings.multipliers);
  take("tangent", settings.tangent);
  take("projections", settings.projections);
  take("projections_every", settings.projections_every);
  take("precision", settings.precision);
  take("geometric_stiffness", settings.geometric_stiffness);
  if (taken == static_cast<py::ssize_t>(given.size())) return options;
  throw Refused("settings: found " +
                py::str(", ").attr("join")(py::list(given)).cast<std::string>() + ", allowed are " +
                names);
}

}  // namespace mbs::python
