// The compiled part of Python's package `mbs`: stepper.hpp with numpy arrays.
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <limits>
#include <mbs/stepper.hpp>
#include <optional>

namespace py = pybind11;

namespace {

using Array = py::array_t<double, py::array::c_style | py::array::forcecast>;

/// A read-only array over numbers that `owner` has: no copy.
py::array view(std::span<const double> numbers, py::handle owner) {
  py::array_t<double> array(static_cast<py::ssize_t>(numbers.size()), numbers.data(), owner);
  array.attr("flags").attr("writeable") = false;
  return array;
}

std::vector<std::string> list(std::span<const std::string> names) {
  return {names.begin(), names.end()};
}

mbs::SceneDocument scene_of(const py::object& source, const std::string& name) {
  if (py::isinstance<mbs::SceneDocument>(source)) return source.cast<mbs::SceneDocument>();
  if (py::isinstance<py::dict>(source)) {
    const py::object text = py::module_::import("json").attr("dumps")(source);
    return mbs::SceneDocument::parse(text.cast<std::string>(), name);
  }
  return mbs::SceneDocument::load(
      py::module_::import("os").attr("fspath")(source).cast<std::string>());
}

std::string name_of(mbs::StepStatus status) {
  switch (status) {
    case mbs::StepStatus::converged:
      return "converged";
    case mbs::StepStatus::pass_limit:
      return "pass_limit";
    case mbs::StepStatus::factorization_failed:
      break;
  }
  return "factorization_failed";
}

/// (steps, inputs) values, or (steps, inputs, 3) with rate and acceleration.
class InputRows {
 public:
  InputRows(const std::optional<Array>& rows, long steps, std::size_t inputs) {
    if (!rows) return;
    const py::ssize_t dimensions = rows->ndim();
    const bool fits = (dimensions == 2 || (dimensions == 3 && rows->shape(2) == 3)) &&
                      rows->shape(0) == steps && rows->shape(1) == static_cast<py::ssize_t>(inputs);
    if (!fits)
      throw mbs::Refused(
          "inputs: an array of (steps, inputs) or (steps, inputs, 3) numbers is needed");
    next_ = rows->data();
    inputs_ = static_cast<int>(inputs);
    with_rates_ = dimensions == 3;
  }
  void set(mbs::Stepper& stepper) {
    for (int i = 0; i < inputs_; ++i) {
      if (with_rates_) {
        stepper.set_input(i, next_[0], next_[1], next_[2]);
      } else {
        stepper.set_input(i, next_[0]);
      }
      next_ += with_rates_ ? 3 : 1;
    }
  }

 private:
  const double* next_ = nullptr;
  int inputs_ = 0;
  bool with_rates_ = false;
};

/// Rows of (t, outputs...) after every `every`-th of `steps` steps, fewer where a step's
/// factorization fails; and how many steps ended at the pass limit.
py::tuple run(mbs::Stepper& self, long steps, long every, const std::optional<Array>& inputs) {
  if (steps < 0 || every < 1) throw mbs::Refused("steps: at least 0; every: at least 1");
  InputRows rows(inputs, steps, self.input_names().size());
  const auto columns = static_cast<py::ssize_t>(self.output_names().size() + 1);
  py::array_t<double> table({static_cast<py::ssize_t>(steps / every), columns});
  double* place = table.mutable_data();
  py::ssize_t written = 0;
  long at_limit = 0;
  {
    const py::gil_scoped_release others_may_run;
    for (long i = 1; i <= steps; ++i) {
      rows.set(self);
      const mbs::StepStatus status = self.step().status;
      if (status == mbs::StepStatus::factorization_failed) break;
      at_limit += status == mbs::StepStatus::pass_limit;
      if (i % every != 0) continue;
      *place++ = self.state().t;
      place = std::ranges::copy(self.outputs(), place).out;
      ++written;
    }
  }
  return py::make_tuple(table[py::slice(0, written, 1)], at_limit);
}

/// (lanes, rows, 1 + outputs), not a number from where a lane's factorization fails.
py::array run_lanes(mbs::BatchStepper& self, long steps, long every) {
  if (steps < 0 || every < 1) throw mbs::Refused("steps: at least 0; every: at least 1");
  const auto columns = static_cast<py::ssize_t>(self.output_names().size() + 1);
  const py::ssize_t rows = steps / every, lanes = self.lanes();
  py::array_t<double> table({lanes, rows, columns});
  double* first = table.mutable_data();
  {
    const py::gil_scoped_release others_may_run;
    for (long i = 1; i <= steps; ++i) {
      const auto outcomes = self.step();
      for (int lane = 0; lane < lanes && i % every == 0; ++lane) {
        double* place = first + (lane * rows + i / every - 1) * columns;
        if (outcomes[static_cast<std::size_t>(lane)].status ==
            mbs::StepStatus::factorization_failed) {
          std::fill_n(place, columns, std::numeric_limits<double>::quiet_NaN());
          continue;
        }
        *place++ = self.state(lane).t;
        std::ranges::copy(self.outputs(lane), place);
      }
    }
  }
  return table;
}

mbs::StepperOptions options_of(const std::string& implementation, double step, double penalty,
                               double tolerance, mbs::Scheme scheme, mbs::Projections projections,
                               int max_passes) {
  mbs::StepperOptions options{implementation};
  options.settings.step = step;
  options.settings.penalty = penalty;
  options.settings.tolerance = tolerance;
  options.settings.scheme = scheme;
  options.settings.projections = projections;
  options.settings.max_passes = max_passes;
  return options;
}

/// A class whose constructor takes what StepperOptions has, by keyword.
template <class Class, class Scenes>
void add_constructor(py::class_<Class>& self, const char* scenes) {
  self.def(py::init([](const Scenes& of, const std::string& implementation, double step,
                       double penalty, double tolerance, mbs::Scheme scheme,
                       mbs::Projections projections, int max_passes) {
             return Class(of, options_of(implementation, step, penalty, tolerance, scheme,
                                         projections, max_passes));
           }),
           py::arg(scenes), py::arg("implementation") = "auto", py::kw_only(),
           py::arg("step") = mbs::StepSettings{}.step, py::arg("penalty") = 0.0,
           py::arg("tolerance") = 0.0, py::arg("scheme") = mbs::Scheme::penalty,
           py::arg("projections") = mbs::Projections::both,
           py::arg("max_passes") = mbs::StepSettings{}.max_passes);
}

template <class Enum>
void add_choice(py::module_& module, const char* name,
                std::initializer_list<std::pair<const char*, Enum>> values) {
  py::enum_<Enum> choice(module, name);
  for (const auto& [text, value] : values) choice.value(text, value);
}

}  // namespace

PYBIND11_MODULE(_mbs, module) {
  py::register_exception<mbs::Refused>(module, "Refused", PyExc_ValueError);
  py::register_exception<mbs::Unsupported>(module, "Unsupported", PyExc_ValueError);
  module.attr("__version__") = mbs::version();
  add_choice<mbs::Scheme>(module, "Scheme",
                          {{"penalty", mbs::Scheme::penalty},
                           {"saddle_point", mbs::Scheme::saddle_point},
                           {"rattle", mbs::Scheme::rattle},
                           {"rattle4", mbs::Scheme::rattle4},
                           {"rattle6", mbs::Scheme::rattle6},
                           {"multistep6", mbs::Scheme::multistep6}});
  add_choice<mbs::Projections>(module, "Projections",
                               {{"none", mbs::Projections::none},
                                {"velocity", mbs::Projections::velocity},
                                {"both", mbs::Projections::both}});
  module.def("implementations", [] {
    py::list all;
    for (const mbs::Offer& one : mbs::implementations()) {
      all.append(py::dict(py::arg("name") = one.name, py::arg("description") = one.description,
                          py::arg("library") = one.library, py::arg("licence") = one.licence));
    }
    return all;
  });

  py::class_<mbs::SceneDocument>(module, "Scene")
      .def(
          py::init(&scene_of), py::arg("source"), py::arg("name") = "scene",
          "A scene: a path, a name (\"vehicle:4\"), a document as a dict, or another scene to copy")
      .def("__getitem__", &mbs::SceneDocument::number)
      .def("__setitem__", &mbs::SceneDocument::set_number)
      .def("document",
           [](const mbs::SceneDocument& self) {
             return py::module_::import("json").attr("loads")(self.json());
           })
      .def(
          "describe",
          [](const mbs::SceneDocument& self, double step) {
            return py::module_::import("json").attr("loads")(self.describe(step));
          },
          py::arg("step") = mbs::StepSettings{}.step)
      .def_property_readonly("name", &mbs::SceneDocument::name);

  py::class_<mbs::StepOutcome>(module, "StepOutcome")
      .def_property_readonly("status",
                             [](const mbs::StepOutcome& self) { return name_of(self.status); })
      .def_readonly("passes", &mbs::StepOutcome::passes)
      .def_readonly("factorizations", &mbs::StepOutcome::factorizations);
  py::class_<mbs::Saved>(module, "Saved");

  using mbs::Stepper;
  using Self = py::object;
  const auto state_view = [](std::vector<double> mbs::State::*part) {
    return [part](const Self& self) { return view(self.cast<Stepper&>().state().*part, self); };
  };
  py::class_<Stepper> stepper(module, "Stepper");
  add_constructor<Stepper, mbs::SceneDocument>(stepper, "scene");
  stepper.def_property_readonly("implementation", &Stepper::implementation)
      .def_property_readonly("inputs", [](const Stepper& self) { return list(self.input_names()); })
      .def_property_readonly("outputs",
                             [](const Stepper& self) { return list(self.output_names()); })
      .def_property_readonly("dt", [](const Stepper& self) { return self.settings().step; })
      .def_property_readonly("penalty", [](const Stepper& self) { return self.settings().penalty; })
      .def_property_readonly("tolerance",
                             [](const Stepper& self) { return self.settings().tolerance; })
      .def(
          "set",
          [](Stepper& self, const std::string& name, double value, double rate,
             double acceleration) { self.set_input(self.input(name), value, rate, acceleration); },
          py::arg("input"), py::arg("value"), py::arg("rate") = 0.0, py::arg("acceleration") = 0.0)
      .def(
          "step", [](Stepper& self, long steps) { return self.step(steps); }, py::arg("steps") = 1,
          py::call_guard<py::gil_scoped_release>())
      .def("run", run, py::arg("steps"), py::arg("every") = 1, py::arg("inputs") = py::none())
      .def_property_readonly("t", [](Stepper& self) { return self.state().t; })
      .def_property_readonly("q", state_view(&mbs::State::q))
      .def_property_readonly("v", state_view(&mbs::State::v))
      .def_property_readonly("a", state_view(&mbs::State::a))
      .def_property_readonly("multipliers", state_view(&mbs::State::lambda))
      .def_property_readonly(
          "values", [](const Self& self) { return view(self.cast<Stepper&>().outputs(), self); })
      .def("save",
           [](Stepper& self) {
             mbs::Saved moment;
             self.save(moment);
             return moment;
           })
      .def("restore", &Stepper::restore);

  using mbs::BatchStepper;
  py::class_<BatchStepper> batch(module, "BatchStepper");
  add_constructor<BatchStepper, std::vector<mbs::SceneDocument>>(batch, "scenes");
  batch.def_property_readonly("implementation", &BatchStepper::implementation)
      .def_property_readonly("dt", [](const BatchStepper& self) { return self.settings(0).step; })
      .def_property_readonly("lanes", &BatchStepper::lanes)
      .def_property_readonly("is_side_by_side", &BatchStepper::is_side_by_side)
      .def_property_readonly("inputs",
                             [](const BatchStepper& self) { return list(self.input_names()); })
      .def_property_readonly("outputs",
                             [](const BatchStepper& self) { return list(self.output_names()); })
      .def(
          "set",
          [](BatchStepper& self, int lane, int input, double value, double rate,
             double acceleration) { self.set_input(lane, input, value, rate, acceleration); },
          py::arg("lane"), py::arg("input"), py::arg("value"), py::arg("rate") = 0.0,
          py::arg("acceleration") = 0.0)
      .def("run", run_lanes, py::arg("steps"), py::arg("every") = 1);
}
