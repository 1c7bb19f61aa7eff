// Constraints act with -Phi_q^T lambda; what that does to a direction is -lambda dPhi/d(direction).
#include "run/constraint_force.hpp"

#include <optional>
#include <stdexcept>

namespace mbs {
namespace {

Vector3 along(const SceneMotion& motion, const Direction& direction) {
  const Vector3 to = motion.position(direction.to);
  return direction.from < 0 ? to : to - motion.position(direction.from);
}

Vector3 times(const DotConstraint&, const Vector3& w) { return w; }
Vector3 times(const BilinearConstraint& c, const Vector3& w) { return multiply(c.B, w); }
Vector3 times_transposed(const DotConstraint&, const Vector3& u) { return u; }
Vector3 times_transposed(const BilinearConstraint& c, const Vector3& u) {
  return multiply_transposed(c.B, u);
}

/// r_a - r_b as a multiple of the direction: 1, -1, or 0 if it is another.
double multiple(int a, int b, const Direction& direction) {
  if (a == direction.to && (direction.from < 0 || b == direction.from)) return 1.0;
  return a == direction.from && b == direction.to ? -1.0 : 0.0;
}

/// By u and w of Phi = u . B w - s.
template <class Constraint>
std::optional<Vector3> quadratic_gradient(const Constraint& c, const SceneMotion& motion,
                                          const Direction& direction) {
  const double in_u = multiple(c.a, c.b, direction), in_w = multiple(c.c, c.d, direction);
  if (in_u == 0.0 && in_w == 0.0) return std::nullopt;
  return in_u * times(c, along(motion, {c.d, c.c})) +
         in_w * times_transposed(c, along(motion, {c.b, c.a}));
}

/// The coefficients of a point; none if it has none.
std::optional<Vector3> coefficients(const LinearConstraint& c, const Model& model, int point) {
  if (point < 0) return std::nullopt;
  const int offset = model.points()[static_cast<std::size_t>(point)].offset;
  std::optional<Vector3> result;
  for (const auto& term : c.terms) {
    if (offset < 0 || term.coordinate < offset || term.coordinate >= offset + model.dimension()) {
      continue;
    }
    if (!result) result.emplace();
    (*result)[static_cast<std::size_t>(term.coordinate - offset)] = term.coefficient;
  }
  return result;
}

/// dPhi_row / d(direction); none if the row does not have this direction.
std::optional<Vector3> gradient(const Model& model, const SceneMotion& motion, int row,
                                const Direction& direction) {
  auto k = static_cast<std::size_t>(row);
  const auto dots = model.dot_constraints();
  if (k < dots.size()) return quadratic_gradient(dots[k], motion, direction);
  k -= dots.size();
  const auto bilinears = model.bilinear_constraints();
  if (k < bilinears.size()) return quadratic_gradient(bilinears[k], motion, direction);
  const LinearConstraint& linear = model.linear_constraints()[k - bilinears.size()];
  if (const auto at_end = coefficients(linear, model, direction.to)) return at_end;
  const auto at_start = coefficients(linear, model, direction.from);
  if (!at_start) return std::nullopt;
  return -1.0 * *at_start;
}

/// What the rows of a distance, and of angles, do along it.
double tension(const Model& model, const SceneMotion& motion, const State& state,
               const Output& output) {
  const Vector3 u = along(motion, output.first);
  double result = 0.0;
  for (const int row : output.rows) {
    const auto by_first = gradient(model, motion, row, output.first);
    if (by_first) result += state.lambda[static_cast<std::size_t>(row)] * dot(*by_first, u);
  }
  return result / norm(u);
}

/// A turn of `second` by a small angle is one of `first` by its opposite; rows have either or both.
double torque(const Model& model, const SceneMotion& motion, const State& state,
              const Output& output) {
  const Vector3 u = along(motion, output.first), w = along(motion, output.second);
  Vector3 z{0.0, 0.0, 1.0};
  if (model.dimension() == 3) z = (1.0 / norm(cross(u, w))) * cross(u, w);
  double result = 0.0;
  for (const int row : output.rows) {
    const double lambda = state.lambda[static_cast<std::size_t>(row)];
    if (const auto by_second = gradient(model, motion, row, output.second)) {
      result -= lambda * dot(*by_second, cross(z, w));
    } else if (const auto by_first = gradient(model, motion, row, output.first)) {
      result += lambda * dot(*by_first, cross(z, u));
    }
  }
  return result;
}

}  // namespace

double constraint_scalar(const Scene& scene, const SceneMotion& motion, const State& state,
                         const Output& output) {
  switch (output.force) {
    case Output::Force::tension:
      return tension(scene.model, motion, state, output);
    case Output::Force::torque:
      return torque(scene.model, motion, state, output);
    case Output::Force::multiplier:
      return output.factor * state.lambda[static_cast<std::size_t>(output.rows.front())];
    case Output::Force::vector:
      break;
  }
  throw std::logic_error("a force that is no single number");
}

Vector3 constraint_vector(const Scene& scene, const SceneMotion& motion, const State& state,
                          const Output& output) {
  Vector3 result{};
  for (const int row : output.rows) {
    const double lambda = state.lambda[static_cast<std::size_t>(row)];
    const auto by_first = gradient(scene.model, motion, row, output.first);
    if (by_first) result = result - lambda * *by_first;
  }
  return result;
}

}  // namespace mbs
