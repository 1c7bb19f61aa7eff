// Springs, dampers and couples of the reference: Eq. (11).
#include <cmath>
#include <numbers>

#include "reference/reference_simulation.hpp"

namespace mbs {
namespace {

using Real = ReferenceSimulation::Real;
using Triple = std::array<Real, 3>;

Real dot(const Triple& x, const Triple& y) { return x[0] * y[0] + x[1] * y[1] + x[2] * y[2]; }
Triple cross(const Triple& x, const Triple& y) {
  return {x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0]};
}
Triple scaled(Real factor, const Triple& x) {
  return {factor * x[0], factor * x[1], factor * x[2]};
}

/// (z x w) / (w . w)
Triple turning(const Triple& z, const Triple& w) { return scaled(1 / dot(w, w), cross(z, w)); }

}  // namespace

Triple ReferenceSimulation::axis(int point) const {
  return point < 0 ? Triple{0, 0, 1} : position(point);
}

ReferenceSimulation::Element ReferenceSimulation::spring_element(const Spring& spring) const {
  const Real h = settings_.step;
  const Triple d = difference(spring.a, spring.b);
  const Real length = std::sqrt(dot(d, d));
  const Real inverse = length > 0 ? 1 / length : 0;
  const Triple e = scaled(inverse, d);
  Element element;
  element.points = {spring.a, spring.b, -1, -1};
  element.gradient = {e, scaled(-1, e)};
  element.force = spring.stiffness * (length - spring.length) +
                  spring.damping * dot(e, velocity_difference(spring.a, spring.b));
  element.weight = h / 2 * spring.damping + h * h / 4 * spring.stiffness;
  const Real p = std::max(Real{0}, spring.stiffness * (1 - spring.length * inverse));
  element.transverse = h * h / 4 * p;
  return element;
}

ReferenceSimulation::Element ReferenceSimulation::torsion_element(
    const TorsionSpring& spring) const {
  const Real h = settings_.step;
  const Triple z = axis(spring.axis);
  const Triple u = difference(spring.a, spring.b), w = difference(spring.c, spring.d);
  const Triple at_u = turning(z, u), at_w = turning(z, w);
  const Real theta = std::atan2(dot(z, cross(u, w)), dot(u, w));
  const Real s = std::remainder(theta - spring.angle, 2 * std::numbers::pi_v<Real>);
  const Real rate = dot(at_w, velocity_difference(spring.c, spring.d)) -
                    dot(at_u, velocity_difference(spring.a, spring.b));
  Element element;
  element.points = {spring.a, spring.b, spring.c, spring.d};
  element.gradient = {scaled(-1, at_u), at_u, at_w, scaled(-1, at_w)};
  element.force = spring.stiffness * s + spring.damping * rate;
  element.weight = h / 2 * spring.damping + h * h / 4 * spring.stiffness;
  return element;
}

std::vector<ReferenceSimulation::Element> ReferenceSimulation::elements() const {
  std::vector<Element> result;
  for (const Spring& spring : model_.springs()) result.push_back(spring_element(spring));
  for (const TorsionSpring& spring : model_.torsion_springs()) {
    result.push_back(torsion_element(spring));
  }
  return result;
}

ReferenceSimulation::Vector ReferenceSimulation::applied_force() const {
  Vector Q(model_.force().begin(), model_.force().end());
  const auto add = [&](int point, Real factor, const Triple& value) {
    for (int k = 0; point >= 0 && offset(point) >= 0 && k < model_.dimension(); ++k) {
      Q[offset(point) + k] += factor * value[k];
    }
  };
  for (const Element& element : elements()) {  // Eq. (11)
    for (int i = 0; i < 4; ++i) add(element.points[i], -element.force, element.gradient[i]);
  }
  for (const Couple& couple : model_.couples()) {
    const Triple value = turning(axis(couple.axis), difference(couple.a, couple.b));
    add(couple.a, couple.torque, value);
    add(couple.b, -couple.torque, value);
  }
  for (const DrivenMass& mass : model_.driven_mass()) {
    Q[mass.coordinate] -= Real{mass.value} * known_.acceleration(mass.point)[mass.axis];
  }
  return Q;
}

void ReferenceSimulation::add_element(const Element& element) {
  const int dimension = model_.dimension();
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      if (element.points[i] < 0 || element.points[j] < 0) continue;
      const int row = offset(element.points[i]), col = offset(element.points[j]);
      if (row < 0 || col < 0) continue;
      const Triple &x = element.gradient[i], &y = element.gradient[j];
      const Real sign = i == j ? 1 : -1;  // of a transverse block: a spring has two points
      for (int k = 0; k < dimension; ++k) {
        for (int l = 0; l < dimension; ++l) {
          const int place = place_[row + k], other = place_[col + l];
          if (place < other) continue;
          const Real identity = k == l ? sign : 0;
          matrix_.at(place, other) +=
              element.weight * x[k] * y[l] + element.transverse * (identity - x[k] * y[l]);
        }
      }
    }
  }
}

ReferenceSimulation::Vector ReferenceSimulation::weighted_mass_times(const Vector& x) const {
  Vector y = mass_times(x);
  for (const MatrixEntry& entry : last_geometric_) y[entry.row] += entry.value * x[entry.col];
  const int dimension = model_.dimension();
  const auto at = [&](int point, int axis) { return x[offset(point) + axis]; };
  for (const Element& element : last_elements_) {
    Real along = 0;  // g . x
    for (int i = 0; i < 4; ++i) {
      for (int k = 0; element.points[i] >= 0 && offset(element.points[i]) >= 0 && k < dimension;
           ++k) {
        along += element.gradient[i][k] * at(element.points[i], k);
      }
    }
    Triple across{};  // x_a - x_b of a spring
    for (int i = 0; i < 2; ++i) {
      for (int k = 0; offset(element.points[i]) >= 0 && k < dimension; ++k) {
        across[k] += (i == 0 ? 1 : -1) * at(element.points[i], k);
      }
    }
    for (int i = 0; i < 4; ++i) {
      if (element.points[i] < 0 || offset(element.points[i]) < 0) continue;
      for (int k = 0; k < dimension; ++k) {
        y[offset(element.points[i]) + k] +=
            (element.weight - element.transverse) * element.gradient[i][k] * along +
            element.transverse * (i == 0 ? 1 : -1) * across[k];
      }
    }
  }
  return y;
}

}  // namespace mbs
