// Springs, dampers, laws and couples of the reference: Eqs. (11), (18), (19).
#include <cmath>
#include <numbers>
#include <utility>

#include "reference/reference_simulation.hpp"

namespace mbs {
namespace {

using Real = ReferenceSimulation::Real;
using Triple = ReferenceSimulation::Triple;

Triple cross(const Triple& x, const Triple& y) {
  return {x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0]};
}
Triple scaled(Real factor, const Triple& x) {
  return {factor * x[0], factor * x[1], factor * x[2]};
}

/// (z x w) / (w . w)
Triple turning(const Triple& z, const Triple& w) {
  return scaled(1 / ReferenceSimulation::dot(w, w), cross(z, w));
}

/// c(x) and c'(x): Eq. (19).
std::pair<Real, Real> evaluate(const Curve& curve, Real x) {
  std::size_t k = 0;
  while (k < curve.breaks.size() && curve.breaks[k] <= x) ++k;
  const Real z = x - curve.pieces[k].origin;
  const auto& c = curve.pieces[k].coefficients;
  return {c[0] + c[1] * z + c[2] * z * z + c[3] * z * z * z,
          c[1] + 2 * c[2] * z + 3 * c[3] * z * z};
}

}  // namespace

Triple ReferenceSimulation::axis(int point) const {
  return point < 0 ? Triple{0, 0, 1} : position(point);
}

ReferenceSimulation::Response ReferenceSimulation::respond(const Law& law, Real s,
                                                           Real rate) const {
  const Real factor = law.factor.at(known_.time()).value;
  const auto [held, stiffness] = evaluate(law.by_position, s);
  const auto [free, damping] = evaluate(law.by_rate, rate);
  return {factor * (held + free), factor * stiffness, factor * damping, factor * held};
}

template <class Line, class Respond>
ReferenceSimulation::Element ReferenceSimulation::line_element(const Line& line,
                                                               Respond&& respond) const {
  const Real h = settings_.step;
  const Triple d = difference(line.a, line.b);
  const Real length = std::sqrt(dot(d, d));
  const Triple e = scaled(length > 0 ? 1 / length : 0, d);
  const Response response = respond(length, dot(e, velocity_difference(line.a, line.b)));
  // At L = 0 the limit for a force that vanishes there; the spring's rule has the same.
  const Real p = length > 0 ? response.held / length : response.stiffness;
  Element element;
  element.points = {line.a, line.b, -1, -1};
  element.gradient = {e, scaled(-1, e)};
  element.force = response.force;
  element.weight = h / 2 * response.damping + h * h / 4 * response.stiffness;
  element.transverse = h * h / 4 * std::max(Real{0}, p);
  return element;
}

template <class Corner, class Respond>
ReferenceSimulation::Element ReferenceSimulation::corner_element(const Corner& corner,
                                                                 Respond&& respond) const {
  const Real h = settings_.step;
  const Triple z = axis(corner.axis);
  const Triple u = difference(corner.a, corner.b), w = difference(corner.c, corner.d);
  const Triple at_u = turning(z, u), at_w = turning(z, w);
  const Real theta = std::atan2(dot(z, cross(u, w)), dot(u, w));
  const Real rate = dot(at_w, velocity_difference(corner.c, corner.d)) -
                    dot(at_u, velocity_difference(corner.a, corner.b));
  const Response response = respond(theta, rate);
  Element element;
  element.points = {corner.a, corner.b, corner.c, corner.d};
  element.gradient = {scaled(-1, at_u), at_u, at_w, scaled(-1, at_w)};
  element.force = response.force;
  element.weight = h / 2 * response.damping + h * h / 4 * response.stiffness;
  return element;
}

std::vector<ReferenceSimulation::Element> ReferenceSimulation::elements() const {
  std::vector<Element> result;
  const auto linear = [](const auto& spring, Real stretch, Real rate) -> Response {
    const Real held = spring.stiffness * stretch;
    return {held + spring.damping * rate, spring.stiffness, spring.damping, held};
  };
  for (const Spring& spring : model_.springs()) {
    result.push_back(line_element(
        spring, [&](Real s, Real rate) { return linear(spring, s - spring.length, rate); }));
  }
  for (const TorsionSpring& spring : model_.torsion_springs()) {
    result.push_back(corner_element(spring, [&](Real theta, Real rate) {
      const Real turn = 2 * std::numbers::pi_v<Real>;
      return linear(spring, std::remainder(theta - spring.angle, turn), rate);
    }));
  }
  const auto of = [this](const Law& law) {
    return [this, &law](Real s, Real rate) { return respond(law, s, rate); };
  };
  for (const ForceLaw& law : model_.force_laws()) {
    result.push_back(line_element(law, of(law.law)));
  }
  for (const TorqueLaw& law : model_.torque_laws()) {
    result.push_back(corner_element(law, of(law.law)));
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
  for (const Element& element : elements()) {  // Eqs. (11), (18)
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
