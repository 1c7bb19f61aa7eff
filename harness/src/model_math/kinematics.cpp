// Direct transcription of Eqs. (7), (8), (11) and (18) of paper/README.md, and of the energy.
#include "model_math/kinematics.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

#include "model_math/known_motion.hpp"
#include "model_math/monotone_curve.hpp"
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
  [[nodiscard]] double time() const { return known_.time(); }
  /// The axis of a torsion spring, torque law or couple.
  [[nodiscard]] Vector3 axis(int point) const {
    return point < 0 ? Vector3{0.0, 0.0, 1.0} : position(point);
  }
  /// Of constraint `c`, which is `row` of Phi.
  template <class Constraint>
  [[nodiscard]] TimeFunction::Sample value(const Constraint& c, std::size_t row) const {
    return model_.driven_values().empty() ? TimeFunction::Sample{c.value} : known_.values()[row];
  }
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

/// theta of a torsion spring or torque law, in -pi ... pi.
template <class Element>
double corner(const Element& element, const Motion& motion) {
  const Vector3 u = motion.r(element.a, element.b), w = motion.r(element.c, element.d);
  return std::atan2(dot(motion.axis(element.axis), cross(u, w)), dot(u, w));
}

/// theta - angle of a torsion spring, in -pi ... pi.
double twist(const TorsionSpring& spring, const Motion& motion) {
  return std::remainder(corner(spring, motion) - spring.angle, 2.0 * std::numbers::pi);
}
double twist(const TorqueLaw& law, const Motion& motion) { return corner(law, motion); }

double length(const Vector3& d) { return std::sqrt(dot(d, d)); }

/// F of Eq. (18).
double force_of(const Law& law, double s, double rate, double t) {
  return law.factor.at(t).value * (law.by_position.at(s).value + law.by_rate.at(rate).value);
}
/// None where the factor changes: then it is no potential.
double potential_of(const Law& law, double s) {
  return law.factor.is_constant() ? law.factor.at(0.0).value * integral(law.by_position, s) : 0.0;
}
bool is_conservative(const Law& law) { return law.by_rate.is_zero() && law.factor.is_constant(); }

/// The gradient of the angle of w against axis z: (z x w) / (w . w).
Vector3 turning(const Vector3& z, const Vector3& w) { return (1.0 / dot(w, w)) * cross(z, w); }

/// Along the line of `element`, `tension` a function of its length and rate.
template <class Element, class Function>
void add_along(const Element& element, const Motion& motion, ForceVector& force,
               Function&& tension) {
  const Vector3 d = motion.r(element.a, element.b);
  const double distance = length(d);
  const Vector3 e = (distance > 0.0 ? 1.0 / distance : 0.0) * d;
  const double rate = dot(e, motion.v(element.a, element.b));
  force.add_pair(element.a, element.b, -tension(distance, rate) * e);
}

/// About the axis of `element`, `torque` a function of its twist and rate.
template <class Element, class Function>
void add_about(const Element& element, const Motion& motion, ForceVector& force,
               Function&& torque) {
  const Vector3 z = motion.axis(element.axis);
  const Vector3 at_u = turning(z, motion.r(element.a, element.b));
  const Vector3 at_w = turning(z, motion.r(element.c, element.d));
  const double rate =
      dot(at_w, motion.v(element.c, element.d)) - dot(at_u, motion.v(element.a, element.b));
  const double turned = torque(twist(element, motion), rate);
  force.add_pair(element.c, element.d, -turned * at_w);
  force.add_pair(element.a, element.b, turned * at_u);
}

void add_springs(const Model& model, const Motion& motion, ForceVector& force) {  // Eq. (11)
  for (const Spring& spring : model.springs()) {
    add_along(spring, motion, force, [&spring](double s, double rate) {
      return spring.stiffness * (s - spring.length) + spring.damping * rate;
    });
  }
  for (const TorsionSpring& spring : model.torsion_springs()) {
    add_about(spring, motion, force, [&spring](double s, double rate) {
      return spring.stiffness * s + spring.damping * rate;
    });
  }
}

void add_laws(const Model& model, const Motion& motion, ForceVector& force) {
  const auto of = [&motion](const Law& law) {
    return [&law, t = motion.time()](double s, double rate) { return force_of(law, s, rate, t); };
  };
  for (const ForceLaw& law : model.force_laws()) add_along(law, motion, force, of(law.law));
  for (const TorqueLaw& law : model.torque_laws()) add_about(law, motion, force, of(law.law));
}

/// |cosine| between an axis and what it turns; planar: 0.
double tilt_of(int axis, const Vector3& turned, const Motion& motion) {
  if (axis < 0) return 0.0;
  const Vector3 z = motion.axis(axis);
  return std::abs(dot(z, turned)) / (norm(z) * norm(turned));
}

/// `can_turn_on`: beyond half a turn its torque is as it was.
template <class Element>
Torsion torsion(const Element& element, const Motion& motion, bool can_turn_on) {
  const double tilt = std::max(tilt_of(element.axis, motion.r(element.a, element.b), motion),
                               tilt_of(element.axis, motion.r(element.c, element.d), motion));
  return {element.name, twist(element, motion), tilt, can_turn_on};
}

}  // namespace

void evaluate_constraints(const Model& model, double t, Coordinates q, std::span<double> phi) {
  const Motion motion(model, t, q);
  require_size(phi.size(), model.constraints(), "phi");
  std::size_t row = 0;
  for_quadratic(model, [&](const auto& c) {  // Eq. (7)
    const Vector3 u = motion.r(c.a, c.b);
    const bool is_distance = c.a == c.c && c.b == c.d;
    phi[row] = product(c, u, is_distance ? u : motion.r(c.c, c.d)) - motion.value(c, row).value;
    ++row;
  });
  for (const LinearConstraint& c : model.linear_constraints()) {  // Eq. (8)
    phi[row] = sum_of_terms(c, q) - motion.value(c, row).value;
    ++row;
  }
}

void constraint_rate(const Model& model, double t, Coordinates q, Coordinates v,
                     std::span<double> rate) {
  const Motion motion(model, t, q, v);
  require_size(v.size(), model.variables(), "v");
  require_size(rate.size(), model.constraints(), "rate");
  std::size_t row = 0;
  for_quadratic(model, [&](const auto& c) {
    rate[row] = product(c, motion.v(c.a, c.b), motion.r(c.c, c.d)) +
                product(c, motion.r(c.a, c.b), motion.v(c.c, c.d)) - motion.value(c, row).rate;
    ++row;
  });
  for (const LinearConstraint& c : model.linear_constraints()) {
    rate[row] = sum_of_terms(c, v) - motion.value(c, row).rate;
    ++row;
  }
}

void constraint_curvature(const Model& model, double t, Coordinates q, Coordinates v,
                          std::span<double> curvature) {
  const Motion motion(model, t, q, v);
  require_size(v.size(), model.variables(), "v");
  require_size(curvature.size(), model.constraints(), "curvature");
  std::size_t row = 0;
  for_quadratic(model, [&](const auto& c) {  // Eq. (7)
    curvature[row] = 2 * product(c, motion.v(c.a, c.b), motion.v(c.c, c.d)) +
                     product(c, motion.a(c.a, c.b), motion.r(c.c, c.d)) +
                     product(c, motion.r(c.a, c.b), motion.a(c.c, c.d)) -
                     motion.value(c, row).acceleration;
    ++row;
  });
  for (const LinearConstraint& c : model.linear_constraints()) {  // Eq. (8)
    curvature[row] = -motion.value(c, row).acceleration;
    ++row;
  }
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
  add_springs(model, motion, sum);
  add_laws(model, motion, sum);
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
  const bool has_tilting = model.dimension() == 3 && !model.couples().empty();
  if (model.torsion_springs().empty() && model.torque_laws().empty() && !has_tilting) return result;
  const Motion motion(model, t, q);
  for (const TorsionSpring& spring : model.torsion_springs()) {
    result.push_back(torsion(spring, motion, spring.stiffness == 0.0));
  }
  for (const TorqueLaw& law : model.torque_laws()) {
    result.push_back(torsion(law, motion, law.law.by_position.is_zero()));
  }
  for (const Couple& couple : model.couples()) {  // its twist makes no difference
    const double tilt = tilt_of(couple.axis, motion.r(couple.a, couple.b), motion);
    result.push_back({couple.name, 0.0, tilt, true});
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
  if (model.springs().empty() && model.torsion_springs().empty() && model.force_laws().empty() &&
      model.torque_laws().empty()) {
    return result;
  }
  const Motion motion(model, t, q);
  for (const Spring& spring : model.springs()) {
    const double stretch = length(motion.r(spring.a, spring.b)) - spring.length;
    result += spring.stiffness / 2 * stretch * stretch;
  }
  for (const TorsionSpring& spring : model.torsion_springs()) {
    const double angle = twist(spring, motion);
    result += spring.stiffness / 2 * angle * angle;
  }
  for (const ForceLaw& law : model.force_laws()) {
    result += potential_of(law.law, length(motion.r(law.a, law.b)));
  }
  for (const TorqueLaw& law : model.torque_laws()) {
    result += potential_of(law.law, twist(law, motion));
  }
  return result;
}

double energy(const Model& model, double t, Coordinates q, Coordinates v) {
  return kinetic_energy(model, v) + potential_energy(model, t, q);
}

bool is_driven(const Model& model) {
  return !model.driven_points().empty() || !model.driven_values().empty();
}

bool is_conservative(const Model& model) {
  const auto damped = [](const auto& spring) { return spring.damping != 0.0; };
  const auto keeps = [](const auto& law) { return is_conservative(law.law); };
  return std::ranges::none_of(model.springs(), damped) &&
         std::ranges::none_of(model.torsion_springs(), damped) &&
         std::ranges::all_of(model.force_laws(), keeps) &&
         std::ranges::all_of(model.torque_laws(), keeps) && model.couples().empty() &&
         !is_driven(model);
}

}  // namespace mbs
