// Evaluates the elements of Eq. (11).
#include "forces.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace mbs::ublas_sparse {
namespace {

void add_at(const Points& points, int point, double factor, const Triple& x, Vector& sum) {
  if (!points.is_free(point)) return;
  for (int k = 0; k < points.dimension(); ++k) sum(point + k) += factor * x[k];
}

/// z x w, z the unit vector at `axis`, or (0, 0, 1) for axis = -1.
Triple turned(const Points& points, int axis, const Triple& w) {
  if (axis < 0) return {-w[1], w[0], 0.0};
  const double* z = points.position() + axis;
  return {z[1] * w[2] - z[2] * w[1], z[2] * w[0] - z[0] * w[2], z[0] * w[1] - z[1] * w[0]};
}

Triple scaled(double factor, const Triple& x) {
  return {factor * x[0], factor * x[1], factor * x[2]};
}

}  // namespace

Forces::Forces(const Model& model, const Points& points, double step) : scale_(step * step / 4.0) {
  const auto axis = [&](int point) { return point < 0 ? -1 : points.first(point); };
  const auto weight = [&](const auto& element) {
    return step / 2.0 * element.damping + scale_ * element.stiffness;
  };
  for (const Spring& spring : model.springs()) {
    springs_.push_back({points.first(spring.a), points.first(spring.b), spring.stiffness,
                        spring.damping, spring.length, weight(spring)});
  }
  for (const TorsionSpring& torsion : model.torsion_springs()) {
    torsions_.push_back({{points.first(torsion.a), points.first(torsion.b), points.first(torsion.c),
                          points.first(torsion.d)},
                         axis(torsion.axis),
                         torsion.stiffness,
                         torsion.damping,
                         torsion.angle,
                         weight(torsion)});
  }
  for (const Couple& couple : model.couples()) {
    couples_.push_back(
        {points.first(couple.a), points.first(couple.b), axis(couple.axis), couple.torque});
  }
}

void Forces::subtract_force(const Points& points, Vector& rhs) {
  for (SpringElement& spring : springs_) evaluate(points, spring, rhs);
  for (TorsionElement& torsion : torsions_) evaluate(points, torsion, rhs);
  for (const CoupleElement& couple : couples_) evaluate(points, couple, rhs);
}

void Forces::evaluate(const Points& points, SpringElement& spring, Vector& rhs) const {
  const Triple d = points.difference(points.position(), spring.a, spring.b);
  const double L = std::sqrt(dot(d, d));
  const double inverse = L == 0.0 ? 0.0 : 1.0 / L;
  spring.e = scaled(inverse, d);
  const double rate = dot(spring.e, points.difference(points.velocity(), spring.a, spring.b));
  const double force = spring.stiffness * (L - spring.length) + spring.damping * rate;  // Eq. (11)
  spring.transverse =
      scale_ * std::max(0.0, spring.stiffness * (1.0 - spring.length * inverse));  // p of G
  add_at(points, spring.a, force, spring.e, rhs);
  add_at(points, spring.b, -force, spring.e, rhs);
}

void Forces::evaluate(const Points& points, TorsionElement& torsion, Vector& rhs) const {
  const auto [a, b, c, d] = torsion.points;
  const Triple u = points.difference(points.position(), a, b);
  const Triple w = points.difference(points.position(), c, d);
  const Triple zu = turned(points, torsion.axis, u), zw = turned(points, torsion.axis, w);
  const double theta = std::atan2(dot(zu, w), dot(u, w));  // z . (u x w) = (z x u) . w
  const double s = std::remainder(theta - torsion.angle, 2.0 * std::numbers::pi);
  const double per_u = 1.0 / dot(u, u), per_w = 1.0 / dot(w, w);
  torsion.gradient = {scaled(-per_u, zu), scaled(per_u, zu), scaled(per_w, zw), scaled(-per_w, zw)};
  const double rate = dot(torsion.gradient[0], points.difference(points.velocity(), a, b)) +
                      dot(torsion.gradient[2], points.difference(points.velocity(), c, d));
  const double moment = torsion.stiffness * s + torsion.damping * rate;  // Eq. (11)
  for (int p = 0; p < 4; ++p) add_at(points, torsion.points[p], moment, torsion.gradient[p], rhs);
}

void Forces::evaluate(const Points& points, const CoupleElement& couple, Vector& rhs) const {
  const Triple w = points.difference(points.position(), couple.a, couple.b);
  const Triple zw = turned(points, couple.axis, w);
  const double force = couple.torque / dot(w, w);
  add_at(points, couple.a, -force, zw, rhs);
  add_at(points, couple.b, force, zw, rhs);
}

}  // namespace mbs::ublas_sparse
