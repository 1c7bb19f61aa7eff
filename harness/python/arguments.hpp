// What Python gives, as C++ takes it; pybind11's own refusals are many lines.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <limits>
#include <mbs/stepper.hpp>
#include <string>
#include <type_traits>
#include <vector>

namespace mbs::python {

namespace py = pybind11;

using Array = py::array_t<double, py::array::c_style | py::array::forcecast>;

std::string type_name(const py::object& type);

/// What a `Value` is called in messages.
template <class Value>
std::string wanted() {
  using Plain = std::remove_cvref_t<Value>;
  if constexpr (std::is_same_v<Plain, bool>) {
    return "True or False";
  } else if constexpr (std::is_same_v<Plain, double>) {
    return "a number";
  } else if constexpr (std::is_integral_v<Plain>) {
    return "a whole number of up to " + std::to_string(std::numeric_limits<Plain>::max());
  } else if constexpr (std::is_same_v<Plain, std::string>) {
    return "a text";
  } else if constexpr (std::is_same_v<Plain, Array>) {
    return "an array of numbers";
  } else {
    return "an mbs." + type_name(py::type::of<Plain>());
  }
}

/// `given`, which messages call `name`, as a `Value`. Throws Refused.
template <class Value>
Value as(const char* name, const py::object& given) {
  try {
    return given.cast<Value>();
  } catch (const py::cast_error&) {
  } catch (const py::reference_cast_error&) {  // None
  } catch (const py::error_already_set&) {     // numpy's own
  }
  throw Refused(std::string(name) + ": found " + type_name(py::type::of(given)) + ", allowed is " +
                wanted<Value>());
}

/// A path, a name, a document or another scene.
SceneDocument scene_of(const py::object& source, const std::string& name);
/// A list of these, one or more.
std::vector<SceneDocument> scenes_of(const py::object& sources);
/// The settings by keyword.
StepperOptions options_of(const py::object& implementation, const py::kwargs& given);

}  // namespace mbs::python
