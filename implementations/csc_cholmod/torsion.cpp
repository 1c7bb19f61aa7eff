// One element after the other; in the plane third components are zeros.
#include "torsion.hpp"

#include <cmath>
#include <numbers>

namespace mbs::csc_cholmod {
namespace {

using Vector = std::array<double, 3>;

Vector at(const double* x, const Places& p) { return {x[p[0]], x[p[1]], x[p[2]]}; }

Vector difference(const double* x, const Places& p, const Places& m) {
  return {x[p[0]] - x[m[0]], x[p[1]] - x[m[1]], x[p[2]] - x[m[2]]};
}

double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// (z x w) / (w . w): how the angle of w about z changes with w.
Vector turn(const Vector& z, const Vector& w) {
  const double square = dot(w, w);
  const Vector direction = cross(z, w);
  return {direction[0] / square, direction[1] / square, direction[2] / square};
}

}  // namespace

TorsionSprings::TorsionSprings(int dimension, const std::vector<TorsionElement>& elements,
                               const std::vector<ScaledLaw>& laws, const StepSettings& settings)
    : dimension_(dimension),
      elements_(elements),
      laws_(laws),
      half_(settings.step / 2.0),
      quarter_(half_ * half_),
      numbers_(elements.size()) {}

ElementForce TorsionSprings::force(const TorsionElement& e, double angle, double rate) const {
  if (e.law >= 0) return laws_[e.law].at(angle, rate);
  const double deviation = std::remainder(angle - e.angle, 2.0 * std::numbers::pi);
  const double stiffness = quarter_ * e.stiffness;
  const double damping = half_ * e.damping;
  return {stiffness * deviation, damping * rate, stiffness, damping};
}

void TorsionSprings::evaluate(const double* q, const double* u) {
  Numbers* numbers = numbers_.data();
  for (const TorsionElement& e : elements_) {
    const Vector z = at(q, e.axis);
    const Vector from = difference(q, e.a, e.b);
    const Vector to = difference(q, e.c, e.d);
    const Vector g_u = turn(z, from);
    const Vector g_w = turn(z, to);
    const double angle = std::atan2(dot(z, cross(from, to)), dot(from, to));
    const double rate = dot(g_w, difference(u, e.c, e.d)) - dot(g_u, difference(u, e.a, e.b));
    const ElementForce f = force(e, angle, rate);
    numbers->torque = -(f.spring + f.damper);  // Eqs. (11), (18)
    numbers->weight = f.damping + f.stiffness;
    for (int axis = 0; axis < dimension_; ++axis) {
      numbers->g[axis] = g_u[axis];
      numbers->g[dimension_ + axis] = g_w[axis];
    }
    ++numbers;
  }
}

double* TorsionSprings::loads(double* summands) const {
  for (const Numbers& n : numbers_) {
    for (int i = 0; i < 2 * dimension_; ++i) *summands++ = n.torque * n.g[i];  // Eqs. (11), (18)
  }
  return summands;
}

double* TorsionSprings::tangent(double* products) const {
  for (const Numbers& n : numbers_) {
    for (int i = 0; i < 2 * dimension_; ++i) {
      for (int j = i; j < 2 * dimension_; ++j) *products++ = n.weight * n.g[i] * n.g[j];
    }
  }
  return products;
}

Couples::Couples(int dimension, const std::vector<CoupleElement>& elements,
                 const StepSettings& settings)
    : dimension_(dimension), elements_(elements), quarter_(settings.step * settings.step / 4.0) {}

double* Couples::loads(const double* q, double* summands) const {
  for (const CoupleElement& e : elements_) {
    const Vector force = turn(at(q, e.axis), difference(q, e.a, e.b));
    for (int axis = 0; axis < dimension_; ++axis) *summands++ = quarter_ * e.torque * force[axis];
  }
  return summands;
}

}  // namespace mbs::csc_cholmod
