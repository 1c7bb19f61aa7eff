// Direct transcription of Eqs. (7), (8) and (11) of paper/README.md, and of the energy.
#include "model_math/kinematics.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

#include "model_math/known_motion.hpp"
#include "model_math/vector3.hpp"

namespace mbs {
namespace {

using Coordinates = std::span<const double>;

void require_size(std::size_t found, int needed, const char* name) {
  if (found != static_cast<std::size_t>(needed)) {
    throw std::invalid_argument(std::string(name) + " has " + std::to_string(found) +
                                " entries, the model needs " + std::to_string(needed));
  }
}

/// Positions and velocities of all points at one instant.
class Motion {
 public:
  Motion(const Model& model, double t, Coordinates q, Coordinates v = {})
      : model_(model), known_(model, t), q_(q), v_(v) {
    require_size(q.size(), model.variables(), "q");
    if (v.data() != nullptr) require_size(v.size(), model.variables(), "v");
  }

  [[nodiscard]] Vector3 position(int point) const {
    return is_fixed(point) ? known_.position(point) : of(point, q_);
  }
  [[nodiscard]] Vector3 velocity(int point) const {
    return is_fixed(point) ? known_.velocity(point) : of(point, v_);
  }
  [[nodiscard]] Vector3 known_acceleration(int point) const {
    return is_fixed(point) ? known_.acceleration(point) : Vector3{};
  }
  /// r_a - r_b and the like.
  [[nodiscard]] Vector3 r(int a, int b) const { return position(a) - position(b); }
  [[nodiscard]] Vector3 v(int a, int b) const { return velocity(a) - velocity(b); }
  [[nodiscard]] Vector3 a(int a, int b) const {
    return known_acceleration(a) - known_acceleration(b);
  }
  /// The axis of a torsion spring or couple.
  [[nodiscard]] Vector3 axis(int point) const {
    return point < 0 ? Vector3{0.0, 0.0, 1.0} : position(point);
  }
  [[nodiscard]] const std::vector<TimeFunction::Sample>& values() const { return known_.values(); }
  [[nodiscard]] bool is_fixed(int point) const { return at(point).is_fixed(); }
  [[nodiscard]] const Point& at(int point) const {
    return model_.points()[static_cast<std::size_t>(point)];
  }

 private:
  [[nodiscard]] Vector3 of(int point, Coordinates x) const {
    const auto offset = static_cast<std::size_t>(at(point).offset);
    return {x[offset], x[offset + 1], model_.dimension() == 3 ? x[offset + 2] : 0.0};
  }

  const Model& model_;
  KnownMotion known_;
  Coordinates q_, v_;
};

/// u . B w, or u . w for a dot constraint.
double product(const DotConstraint&, const Vector3& u, const Vector3& w) { return dot(u, w); }
double product(const BilinearConstraint& c, const Vector3& u, const Vector3& w) {
  return dot(u, multiply(c.B, w));
}
/// B w and B^T u.
Vector3 right(const DotConstraint&, const Vector3& w) { return w; }
Vector3 right(const BilinearConstraint& c, const Vector3& w) { return multiply(c.B, w); }
Vector3 left(const DotConstraint&, const Vector3& u) { return u; }
Vector3 left(const BilinearConstraint& c, const Vector3& u) { return multiply_transposed(c.B, u); }

template <class Function>
void for_quadratic(const Model& model, Function&& function) {
  for (const DotConstraint& constraint : model.dot_constraints()) function(constraint);
  for (const BilinearConstraint& constraint : model.bilinear_constraints()) function(constraint);
}

double sum_of_terms(const LinearConstraint& constraint, Coordinates x) {
  double sum = 0.0;
  for (const auto& term : constraint.terms) {
    sum += term.coefficient * x[static_cast<std::size_t>(term.coordinate)];
  }
  return sum;
}

/// Appends the row of a quadratic constraint; the coefficients of coinciding points add up.
template <class Constraint>
void append_row(const Model& model, const Constraint& c, const Motion& motion, int row,
                std::vector<JacobianEntry>& entries) {
  const Vector3 at_ab = right(c, motion.r(c.c, c.d));
  const Vector3 at_cd = left(c, motion.r(c.a, c.b));
  const auto begin = static_cast<std::ptrdiff_t>(entries.size());
  const auto add = [&](int index, const Vector3& value, double sign) {
    if (motion.is_fixed(index)) return;
    for (int axis = 0; axis < model.dimension(); ++axis) {
      const int col = motion.at(index).offset + axis;
      const auto found = std::find_if(entries.begin() + begin, entries.end(),
                                      [&](const JacobianEntry& entry) { return entry.col == col; });
      const double term = sign * value[static_cast<std::size_t>(axis)];
      if (found == entries.end()) {
        entries.push_back({row, col, term});
      } else {
        found->value += term;
      }
    }
  };
  add(c.a, at_ab, 1.0);
  add(c.b, at_ab, -1.0);
  add(c.c, at_cd, 1.0);
  add(c.d, at_cd, -1.0);
}

/// Adds forces to the rows of free points.
class ForceVector {
 public:
  ForceVector(const Model& model, const Motion& motion, std::span<double> force)
      : dimension_(model.dimension()), motion_(motion), force_(force) {}

  /// `value` at point a, its opposite at point b.
  void add_pair(int a, int b, const Vector3& value) {
    add(a, value);
    add(b, -1.0 * value);
  }

 private:
  void add(int index, const Vector3& value) {
    if (motion_.is_fixed(index)) return;
    for (int axis = 0; axis < dimension_; ++axis) {
      force_[static_cast<std::size_t>(motion_.at(index).offset + axis)] +=
          value[static_cast<std::size_t>(axis)];
    }
  }

  int dimension_;
  const Motion& motion_;
  std::span<double> force_;
};

/// theta - angle of a torsion spring, in -pi ... pi.
double twist(const TorsionSpring& spring, const Motion& motion) {
  const Vector3 u = motion.r(spring.a, spring.b), w = motion.r(spring.c, spring.d);
  const double theta = std::atan2(dot(motion.axis(spring.axis), cross(u, w)), dot(u, w));
  return std::remainder(theta - spring.angle, 2.0 * std::numbers::pi);
}

/// The gradient of the angle of w against axis z: (z x w) / (w . w).
Vector3 turning(const Vector3& z, const Vector3& w) { return (1.0 / dot(w, w)) * cross(z, w); }

void add_spring(const Spring& spring, const Motion& motion, ForceVector& force) {
  const Vector3 d = motion.r(spring.a, spring.b);
  const double length = std::sqrt(dot(d, d));
  const Vector3 e = (length > 0.0 ? 1.0 / length : 0.0) * d;
  const double rate = dot(e, motion.v(spring.a, spring.b));
  const double tension = spring.stiffness * (length - spring.length) + spring.damping * rate;
  force.add_pair(spring.a, spring.b, -tension * e);
}

void add_torsion_spring(const TorsionSpring& spring, const Motion& motion, ForceVector& force) {
  const Vector3 z = motion.axis(spring.axis);
  const Vector3 at_u = turning(z, motion.r(spring.a, spring.b));
  const Vector3 at_w = turning(z, motion.r(spring.c, spring.d));
  const double rate =
      dot(at_w, motion.v(spring.c, spring.d)) - dot(at_u, motion.v(spring.a, spring.b));
  const double torque = spring.stiffness * twist(spring, motion) + spring.damping * rate;
  force.add_pair(spring.c, spring.d, -torque * at_w);
  force.add_pair(spring.a, spring.b, torque * at_u);
}

}  // namespace

void evaluate_constraints(const Model& model, double t, Coordinates q, std::span<double> phi) {
  const Motion motion(model, t, q);
  require_size(phi.size(), model.constraints(), "phi");
  std::size_t row = 0;
  const bool is_driven = !model.driven_values().empty();
  const auto value = [&](const auto& c) {
    return is_driven ? motion.values()[row].value : c.value;
  };
  for_quadratic(model, [&](const auto& c) {  // Eq. (7)
    phi[row] = product(c, motion.r(c.a, c.b), motion.r(c.c, c.d)) - value(c);
    ++row;
  });
  for (const LinearConstraint& constraint : model.linear_constraints()) {  // Eq. (8)
    phi[row] = sum_of_terms(constraint, q) - value(constraint);
    ++row;
  }
}

void constraint_rate(const Model& model, double t, Coordinates q, Coordinates v,
                     std::span<double> rate) {
  const Motion motion(model, t, q, v);
  require_size(v.size(), model.variables(), "v");
  require_size(rate.size(), model.constraints(), "rate");
  std::size_t row = 0;
  const auto& values = motion.values();
  for_quadratic(model, [&](const auto& c) {
    rate[row] = product(c, motion.v(c.a, c.b), motion.r(c.c, c.d)) +
                product(c, motion.r(c.a, c.b), motion.v(c.c, c.d)) - values[row].rate;
    ++row;
  });
  for (const LinearConstraint& constraint : model.linear_constraints()) {
    rate[row] = sum_of_terms(constraint, v) - values[row].rate;
    ++row;
  }
}

void constraint_curvature(const Model& model, double t, Coordinates q, Coordinates v,
                          std::span<double> curvature) {
  const Motion motion(model, t, q, v);
  require_size(v.size(), model.variables(), "v");
  require_size(curvature.size(), model.constraints(), "curvature");
  std::size_t row = 0;
  const auto& values = motion.values();
  for_quadratic(model, [&](const auto& c) {  // Eq. (7)
    curvature[row] = 2 * product(c, motion.v(c.a, c.b), motion.v(c.c, c.d)) +
                     product(c, motion.a(c.a, c.b), motion.r(c.c, c.d)) +
                     product(c, motion.r(c.a, c.b), motion.a(c.c, c.d)) - values[row].acceleration;
    ++row;
  });
  for (; row < curvature.size(); ++row) curvature[row] = -values[row].acceleration;  // Eq. (8)
}

std::vector<JacobianEntry> jacobian(const Model& model, double t, Coordinates q) {
  const Motion motion(model, t, q);
  std::vector<JacobianEntry> entries;
  int row = 0;
  for_quadratic(model, [&](const auto& c) { append_row(model, c, motion, row++, entries); });
  for (const LinearConstraint& constraint : model.linear_constraints()) {
    for (const auto& term : constraint.terms) {
      entries.push_back({row, term.coordinate, term.coefficient});
    }
    ++row;
  }
  std::sort(entries.begin(), entries.end(), [](const JacobianEntry& x, const JacobianEntry& y) {
    return x.row != y.row ? x.row < y.row : x.col < y.col;
  });
  return entries;
}

void applied_force(const Model& model, double t, Coordinates q, Coordinates v,
                   std::span<double> force) {
  const Motion motion(model, t, q, v);
  require_size(v.size(), model.variables(), "v");
  require_size(force.size(), model.variables(), "force");
  std::ranges::copy(model.force(), force.begin());
  ForceVector sum(model, motion, force);
  for (const Spring& spring : model.springs()) add_spring(spring, motion, sum);
  for (const TorsionSpring& spring : model.torsion_springs()) {
    add_torsion_spring(spring, motion, sum);
  }
  for (const Couple& couple : model.couples()) {
    const Vector3 w = motion.r(couple.a, couple.b);
    sum.add_pair(couple.a, couple.b, couple.torque * turning(motion.axis(couple.axis), w));
  }
  for (const DrivenMass& mass : model.driven_mass()) {
    force[static_cast<std::size_t>(mass.coordinate)] -=
        mass.value * motion.known_acceleration(mass.point)[static_cast<std::size_t>(mass.axis)];
  }
}

std::vector<Torsion> torsions(const Model& model, double t, Coordinates q) {
  std::vector<Torsion> result;
  if (model.torsion_springs().empty()) return result;
  const Motion motion(model, t, q);
  for (const TorsionSpring& spring : model.torsion_springs()) {
    double tilt = 0.0;
    if (spring.axis >= 0) {
      const Vector3 z = motion.axis(spring.axis);
      for (const Vector3& d : {motion.r(spring.a, spring.b), motion.r(spring.c, spring.d)}) {
        tilt = std::max(tilt, std::abs(dot(z, d)) / (norm(z) * norm(d)));
      }
    }
    result.push_back({twist(spring, motion), tilt});
  }
  return result;
}

std::vector<double> mass_diagonal(const Model& model) {
  std::vector<double> result(static_cast<std::size_t>(model.variables()));
  for (const MassEntry& entry : model.mass()) {
    if (entry.row == entry.col) result[static_cast<std::size_t>(entry.row)] = entry.value;
  }
  return result;
}

void mass_times(const Model& model, Coordinates x, std::span<double> y) {
  require_size(x.size(), model.variables(), "x");
  require_size(y.size(), model.variables(), "y");
  std::fill(y.begin(), y.end(), 0.0);
  for (const MassEntry& entry : model.mass()) {
    const auto row = static_cast<std::size_t>(entry.row);
    const auto col = static_cast<std::size_t>(entry.col);
    y[row] += entry.value * x[col];
    if (row != col) y[col] += entry.value * x[row];
  }
}

double kinetic_energy(const Model& model, Coordinates v) {
  require_size(v.size(), model.variables(), "v");
  double result = 0.0;
  for (const MassEntry& entry : model.mass()) {
    const double term = entry.value * v[static_cast<std::size_t>(entry.row)] *
                        v[static_cast<std::size_t>(entry.col)];
    result += entry.row == entry.col ? term / 2 : term;
  }
  return result;
}

double potential_energy(const Model& model, double t, Coordinates q) {
  require_size(q.size(), model.variables(), "q");
  double result = 0.0;
  for (std::size_t i = 0; i < q.size(); ++i) result -= model.force()[i] * q[i];
  if (model.springs().empty() && model.torsion_springs().empty()) return result;
  const Motion motion(model, t, q);
  for (const Spring& spring : model.springs()) {
    const Vector3 d = motion.r(spring.a, spring.b);
    const double stretch = std::sqrt(dot(d, d)) - spring.length;
    result += spring.stiffness / 2 * stretch * stretch;
  }
  for (const TorsionSpring& spring : model.torsion_springs()) {
    const double angle = twist(spring, motion);
    result += spring.stiffness / 2 * angle * angle;
  }
  return result;
}

double energy(const Model& model, double t, Coordinates q, Coordinates v) {
  return kinetic_energy(model, v) + potential_energy(model, t, q);
}

bool is_conservative(const Model& model) {
  const auto damped = [](const auto& spring) { return spring.damping != 0.0; };
  return std::ranges::none_of(model.springs(), damped) &&
         std::ranges::none_of(model.torsion_springs(), damped) && model.couples().empty() &&
         model.driven_points().empty() && model.driven_values().empty();
}

PointMotion point_motion(const Model& model, int point, double t, Coordinates q, Coordinates v,
                         Coordinates a) {
  const Motion motion(model, t, q, v);
  PointMotion result{motion.position(point), motion.velocity(point),
                     motion.known_acceleration(point)};
  if (!motion.is_fixed(point)) {
    for (int axis = 0; axis < model.dimension(); ++axis) {
      const auto k = static_cast<std::size_t>(axis);
      result.a[k] = a[static_cast<std::size_t>(motion.at(point).offset) + k];
    }
  }
  return result;
}

}  // namespace mbs
