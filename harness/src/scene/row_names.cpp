// Names and figures of constraints.
#include "scene/row_names.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "model_math/known_motion.hpp"
#include "printable.hpp"

namespace mbs {
namespace {

std::size_t quadratic_rows(const Model& model) {
  return model.dot_constraints().size() + model.bilinear_constraints().size();
}

}  // namespace

std::string row_name(const Model& model, int row) {
  const auto index = static_cast<std::size_t>(row);
  const std::size_t dots = model.dot_constraints().size();
  if (index < dots) return printable(model.dot_constraints()[index].name);
  const std::size_t quadratic = quadratic_rows(model);
  return printable(index < quadratic ? model.bilinear_constraints()[index - dots].name
                                     : model.linear_constraints()[index - quadratic].name);
}

std::string variable_name(const Model& model, int i) {
  const int axis = i % model.dimension();  // free points tile q with as many coordinates as axes
  const auto owns = [&](const Point& one) { return one.offset == i - axis; };
  return fmt::format("{}.{}", printable(std::ranges::find_if(model.points(), owns)->name),
                     "xyz"[axis]);
}

const char* rate_unit(const Model& model, int row) {
  return static_cast<std::size_t>(row) < quadratic_rows(model) ? "m^2/s" : "m/s";
}

std::string describe_violation(const Model& model, const Violation& violation) {
  const std::string name = row_name(model, violation.row);
  const auto row = static_cast<std::size_t>(violation.row);
  const double wanted = KnownMotion(model, 0.0).values()[row].value;
  if (row < model.dot_constraints().size() && wanted >= 0.0) {
    const DotConstraint& c = model.dot_constraints()[row];
    const double found = violation.value + wanted;
    if (c.is_distance() && found >= 0.0) {
      const double apart = std::sqrt(found), length = std::sqrt(wanted), off = apart - length;
      constexpr double kShown = 1e-3;  // smaller shares are hard to see, or not shown
      return fmt::format(
          "{}: its points are {:.6g} m apart, its length is {:.6g} m{}", name, apart, length,
          std::abs(off) < kShown * length ? fmt::format(" (a difference of {:.3g} m)", off) : "");
    }
  }
  return fmt::format("{}: Phi = {:.3g} {}", name, violation.value,
                     row < quadratic_rows(model) ? "m^2" : "m");
}

}  // namespace mbs
