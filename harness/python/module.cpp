// The compiled part of Python's package `mbs`: stepper.hpp with numpy arrays.
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <limits>
#include <mbs/stepper.hpp>
#include <optional>
#include <string>

#include "arguments.hpp"

namespace py = pybind11;

namespace {

using mbs::python::Array;
using mbs::python::as;
using mbs::python::options_of;
using mbs::python::scene_of;
using mbs::python::scenes_of;

/// A read-only array over numbers that `owner` has: no copy.
py::array view(std::span<const double> numbers, py::handle owner) {
  py::array_t<double> array(static_cast<py::ssize_t>(numbers.size()), numbers.data(), owner);
  array.attr("flags").attr("writeable") = false;
  return array;
}

std::vector<std::string> list(std::span<const std::string> names) {
  return {names.begin(), names.end()};
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

std::pair<long, long> counts(const py::object& of_steps, const py::object& of_every) {
  const auto steps = as<long>("steps", of_steps), every = as<long>("every", of_every);
  if (steps < 0)
    throw mbs::Refused("steps: found " + std::to_string(steps) + ", allowed is 0 or more");
  if (every < 1)
    throw mbs::Refused("every: found " + std::to_string(every) + ", allowed is 1 or more");
  return {steps, every};
}

py::array_t<double> table_of(const std::vector<py::ssize_t>& shape) {
  try {
    return py::array_t<double>(shape);
  } catch (const py::error_already_set&) {  // numpy's own
    throw mbs::Refused("steps: their table does not fit memory; every= keeps fewer rows");
  }
}

/// Rows of (t, outputs...) after every `every`-th of `steps` steps, fewer where a step's
/// factorization fails; and how many steps ended at the pass limit.
py::tuple run(mbs::Stepper& self, const py::object& of_steps, const py::object& of_every,
              const py::object& inputs) {
  const auto [steps, every] = counts(of_steps, of_every);
  std::optional<Array> given;
  if (!inputs.is_none()) given = as<Array>("inputs", inputs);
  InputRows rows(given, steps, self.input_names().size());
  const auto columns = static_cast<py::ssize_t>(self.output_names().size() + 1);
  py::array_t<double> table = table_of({static_cast<py::ssize_t>(steps / every), columns});
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

/// (lanes, rows, 1 + outputs); outputs are not a number from where a lane's factorization fails.
py::array run_lanes(mbs::BatchStepper& self, const py::object& of_steps,
                    const py::object& of_every) {
  const auto [steps, every] = counts(of_steps, of_every);
  const auto columns = static_cast<py::ssize_t>(self.output_names().size() + 1);
  const py::ssize_t rows = steps / every, lanes = self.lanes();
  py::array_t<double> table = table_of({lanes, rows, columns});
  double* first = table.mutable_data();
  {
    const py::gil_scoped_release others_may_run;
    for (long i = 1; i <= steps; ++i) {
      const auto outcomes = self.step();
      for (int lane = 0; lane < lanes && i % every == 0; ++lane) {
        double* place = first + (lane * rows + i / every - 1) * columns;
        if (outcomes[static_cast<std::size_t>(lane)].status ==
            mbs::StepStatus::factorization_failed) {
          *place++ = self.t();
          std::fill_n(place, columns - 1, std::numeric_limits<double>::quiet_NaN());
          continue;
        }
        *place++ = self.state(lane).t;
        std::ranges::copy(self.outputs(lane), place);
      }
    }
  }
  return table;
}

constexpr const char* kSettings =
    "\n\nSettings, by keyword: step (s), penalty, tolerance (m; of both 0 is chosen from the "
    "scene),\n"
    "max_passes, scheme, multipliers, tangent, projections, projections_every, precision,\n"
    "geometric_stiffness: StepSettings of mbs/simulation.hpp.";

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
  add_choice<mbs::MultiplierUpdate>(module, "MultiplierUpdate",
                                    {{"every_pass", mbs::MultiplierUpdate::every_pass},
                                     {"converged", mbs::MultiplierUpdate::converged}});
  add_choice<mbs::TangentReuse>(module, "TangentReuse",
                                {{"none", mbs::TangentReuse::none},
                                 {"step", mbs::TangentReuse::step},
                                 {"kept", mbs::TangentReuse::kept}});
  add_choice<mbs::Precision>(module, "Precision",
                             {{"double_precision", mbs::Precision::double_precision},
                              {"single_precision", mbs::Precision::single_precision},
                              {"mixed", mbs::Precision::mixed}});
  module.def(
      "implementations",
      [] {
        py::list all;
        for (const mbs::Offer& one : mbs::implementations()) {
          all.append(py::dict(py::arg("name") = one.name, py::arg("description") = one.description,
                              py::arg("library") = one.library, py::arg("licence") = one.licence,
                              py::arg("allocates") = one.allocates));
        }
        return all;
      },
      "Of this build, a dict each: name, description, library, its licence, and why a step "
      "allocates "
      "memory (\"\": it does not).");
  module.def("_scenes", scenes_of);

  using mbs::SceneDocument;
  py::class_<SceneDocument>(module, "Scene", "A scene, whose numbers may be changed.")
      .def(py::init([](const py::object& source, const py::object& name) {
             return scene_of(source, as<std::string>("name", name));
           }),
           py::arg("source"), py::arg("name") = "scene",
           "A scene: a path, a name (\"vehicle:4\"), a document as a dict, or another scene to "
           "copy.")
      .def(
          "__getitem__",
          [](const SceneDocument& self, const py::object& path) {
            return self.number(as<std::string>("path", path));
          },
          "A number, by its path as in `mbs sweep --vary`.")
      .def("__setitem__",
           [](SceneDocument& self, const py::object& path, const py::object& value) {
             self.set_number(as<std::string>("path", path), as<double>("value", value));
           })
      .def(
          "document",
          [](const SceneDocument& self) {
            return py::module_::import("json").attr("loads")(self.json());
          },
          "The scene's document as a dict of its own.")
      .def(
          "describe",
          [](const SceneDocument& self, const py::object& step) {
            return py::module_::import("json").attr("loads")(
                self.describe(as<double>("step", step)));
          },
          py::arg("step") = mbs::StepSettings{}.step,
          "What `mbs describe --json` prints for a step of so many s, as a dict.")
      .def_property_readonly("name", &SceneDocument::name, "What messages call it.")
      .def(py::pickle(
          [](const SceneDocument& self) { return py::make_tuple(self.json(), self.name()); },
          [](const py::tuple& parts) {
            return SceneDocument::parse(parts[0].cast<std::string>(), parts[1].cast<std::string>());
          }));

  py::class_<mbs::StepOutcome>(module, "StepOutcome", "How a step, or a block of them, ended.")
      .def_property_readonly(
          "status", [](const mbs::StepOutcome& self) { return name_of(self.status); },
          "\"converged\"; \"pass_limit\": the last iterate; or \"factorization_failed\": "
          "the "
          "state means nothing.")
      .def_readonly("passes", &mbs::StepOutcome::passes, "Passes begun.")
      .def_readonly("factorizations", &mbs::StepOutcome::factorizations, "Factorizations begun.")
      .def("__repr__", [](const mbs::StepOutcome& self) {
        return "StepOutcome(status='" + name_of(self.status) +
               "', passes=" + std::to_string(self.passes) +
               ", factorizations=" + std::to_string(self.factorizations) + ")";
      });
  using mbs::Saved;
  py::class_<Saved>(module, "Saved", "A moment of a Stepper. It belongs to its scene and settings.")
      .def("__copy__", [](const Saved& self) { return Saved(self); })
      .def("__deepcopy__", [](const Saved& self, const py::dict&) { return Saved(self); });

  using mbs::Stepper;
  using Self = py::object;
  const auto state_view = [](std::vector<double> mbs::State::*part) {
    return [part](const Self& self) { return view(self.cast<Stepper&>().state().*part, self); };
  };
  py::class_<Stepper>(module, "Stepper",
                      "One simulation of one scene, from its start on. For one thread at a time.")
      .def(py::init([](const py::object& scene, const py::object& implementation,
                       const py::kwargs& settings) {
             return Stepper(scene_of(scene, "scene"), options_of(implementation, settings));
           }),
           py::arg("scene"), py::arg("implementation") = "auto",
           (std::string(
                "`scene`: what Scene() takes. `implementation`: \"folder/variant\", or \"auto\" "
                "for the one that is expected to be fastest.") +
            kSettings)
               .c_str())
      .def_property_readonly("implementation", &Stepper::implementation, "The one chosen.")
      .def_property_readonly(
          "inputs", [](const Stepper& self) { return list(self.input_names()); },
          "Names of the scene's inputs.")
      .def_property_readonly(
          "outputs", [](const Stepper& self) { return list(self.output_names()); },
          "Names of `values`.")
      .def_property_readonly(
          "dt", [](const Stepper& self) { return self.settings().step; }, "The step, s.")
      .def_property_readonly(
          "scheme", [](const Stepper& self) { return self.settings().scheme; },
          "The scheme, given or chosen with the implementation: who names that needs it too.")
      .def_property_readonly(
          "penalty", [](const Stepper& self) { return self.settings().penalty; },
          "The penalty factor, given or chosen.")
      .def_property_readonly(
          "tolerance", [](const Stepper& self) { return self.settings().tolerance; },
          "Newton's, given or chosen, m.")
      .def(
          "set",
          [](Stepper& self, const py::object& input, const py::object& value,
             const py::object& rate, const py::object& acceleration) {
            self.set_input(self.input(as<std::string>("input", input)), as<double>("value", value),
                           as<double>("rate", rate), as<double>("acceleration", acceleration));
          },
          py::arg("input"), py::arg("value"), py::arg("rate") = 0.0, py::arg("acceleration") = 0.0,
          "What the input of this name is from the end of the next step on. What moves a point or "
          "a\n"
          "constraint (m, rad) needs its rate (per s) and acceleration (per s^2) too, anew for "
          "each "
          "step.")
      .def(
          "step",
          [](Stepper& self, const py::object& steps) {
            const auto count = as<long>("steps", steps);
            const py::gil_scoped_release others_may_run;
            return self.step(count);
          },
          py::arg("steps") = 1,
          "So many steps further, 1 or more; fewer where one fails. The status is the worst of "
          "them,\n"
          "passes and factorizations are sums.")
      .def("run", run, py::arg("steps"), py::arg("every") = 1, py::arg("inputs") = py::none(),
           "(rows, how many steps ended at the pass limit). A row is t and `values` after each\n"
           "`every`-th step: after steps 3, 6 and 9 of 10 for every=3. Fewer rows where a step "
           "fails,\n"
           "unless that is after the last row.\n"
           "`inputs`: (steps, inputs) values, whose rates are 0, or (steps, inputs, 3) with rates "
           "and "
           "accelerations.")
      .def_property_readonly(
          "t", [](Stepper& self) { return self.state().t; }, "Now, s.")
      .def_property_readonly("q", state_view(&mbs::State::q), "Coordinates, m; a view.")
      .def_property_readonly("v", state_view(&mbs::State::v), "Velocities, m/s; a view.")
      .def_property_readonly("a", state_view(&mbs::State::a), "Accelerations, m/s^2; a view.")
      .def_property_readonly("multipliers", state_view(&mbs::State::lambda),
                             "lambda of each constraint, N/m, of linear ones N; a view.")
      .def_property_readonly(
          "values", [](const Self& self) { return view(self.cast<Stepper&>().outputs(), self); },
          "The scene's outputs now, as `outputs` names them; a view.")
      .def(
          "save",
          [](Stepper& self) {
            Saved moment;
            self.save(moment);
            return moment;
          },
          "State and inputs now, for restore().")
      .def(
          "restore",
          [](Stepper& self, const py::object& moment) {
            self.restore(as<const Saved&>("moment", moment));
          },
          py::arg("moment"), "Back to what this or an equal Stepper saved.");

  using mbs::BatchStepper;
  py::class_<BatchStepper>(module, "BatchStepper",
                           "Several scenes with the same inputs and outputs at once, a lane each.")
      .def(py::init([](const py::object& scenes, const py::object& implementation,
                       const py::kwargs& settings) {
             return BatchStepper(scenes_of(scenes), options_of(implementation, settings));
           }),
           py::arg("scenes"), py::arg("implementation") = "auto",
           (std::string("`scenes`: a list of what Scene() takes. \"auto\" chooses for the first.") +
            kSettings)
               .c_str())
      .def_property_readonly("implementation", &BatchStepper::implementation, "The one chosen.")
      .def_property_readonly(
          "dt", [](const BatchStepper& self) { return self.settings(0).step; }, "The step, s.")
      .def_property_readonly("lanes", &BatchStepper::lanes, "How many.")
      .def_property_readonly("is_side_by_side", &BatchStepper::is_side_by_side,
                             "False: one lane is stepped after the other.")
      .def_property_readonly(
          "inputs", [](const BatchStepper& self) { return list(self.input_names()); },
          "Names of the scenes' inputs.")
      .def_property_readonly(
          "outputs", [](const BatchStepper& self) { return list(self.output_names()); },
          "Names of the columns of run(), after t.")
      .def(
          "set",
          [](BatchStepper& self, const py::object& lane, const py::object& input,
             const py::object& value, const py::object& rate, const py::object& acceleration) {
            self.set_input(as<int>("lane", lane), self.input(as<std::string>("input", input)),
                           as<double>("value", value), as<double>("rate", rate),
                           as<double>("acceleration", acceleration));
          },
          py::arg("lane"), py::arg("input"), py::arg("value"), py::arg("rate") = 0.0,
          py::arg("acceleration") = 0.0, "As Stepper.set(), for a lane, from 0 on.")
      .def("run", run_lanes, py::arg("steps"), py::arg("every") = 1,
           "(lanes, rows, 1 + outputs): t and the outputs after each `every`-th step. Outputs are "
           "not a\n"
           "number from where a lane fails.");
}
