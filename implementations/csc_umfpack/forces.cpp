// Springs, torsion springs and couples at the current positions and velocities.
#include "forces.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace mbs::csc_umfpack {
namespace {

/// Adds an element's blocks to T: fill(i, j, S) gives the block of ends i and j. Returns where the
/// places go on.
template <int D, class Fill>
const Place<D>* add_blocks(int ends, const Place<D>* place, double* T, const Fill& fill) {
  double S[D][D];
  for (int i = 0; i < ends; ++i) {
    for (int j = 0; j <= i; ++j, ++place) {
      fill(i, j, S);
      for (int row = 0; row < D; ++row) {
        for (int col = 0; col < D; ++col) T[place->position[col] + row] += S[row][col];
      }
      if (i == j) continue;
      for (int row = 0; row < D; ++row) {
        for (int col = 0; col < D; ++col) T[place->mirrored[row] + col] += S[row][col];
      }
    }
  }
  return place;
}

}  // namespace

template <int D>
Forces<D>::Forces(const Model& model, const PointLayout& points, double step)
    : layout_(model, points),
      half_(step / 2.0),
      quarter_(step * step / 4.0),
      springs_(layout_.springs.size()) {
  if (layout_.torsion_springs.empty()) return;
  gradients_.resize(layout_.torsion_springs.back().last - layout_.torsion_springs.front().first);
}

template <int D>
void Forces<D>::evaluate(const double* x, const double* v, double* y) {
  evaluate_springs(x, v, y);
  evaluate_torsion_springs(x, v, y);
  add_couples(x, y);
}

template <int D>
void Forces<D>::evaluate_springs(const double* x, const double* v, double* y) {
  auto values = springs_.begin();
  for (const auto& spring : layout_.springs) {
    const Vector<D> d = difference<D>(x, spring.a, spring.b);
    const double length = std::sqrt(dot(d, d));
    const double inverse = length > 0.0 ? 1.0 / length : 0.0;
    const Vector<D> e = inverse * d;
    const double rate = dot(e, difference<D>(v, spring.a, spring.b));
    const double across =
        quarter_ * std::max(0.0, spring.stiffness * (1.0 - spring.length * inverse));
    *values++ = {e, weight(spring) - across, across};
    const double force = spring.stiffness * (length - spring.length) + spring.damping * rate;
    for (const auto& end : ends(spring)) {
      add(-quarter_ * force * end.in_ab, e, y + end.offset);  // Eq. (11)
    }
  }
}

template <int D>
void Forces<D>::evaluate_torsion_springs(const double* x, const double* v, double* y) {
  auto gradient = gradients_.begin();
  for (const auto& spring : layout_.torsion_springs) {
    const double* z = x + spring.axis;
    const Vector<D> u = difference<D>(x, spring.a, spring.b);
    const Vector<D> w = difference<D>(x, spring.c, spring.d);
    const Vector<D> across_u = cross(z, u);
    const double angle = std::atan2(dot(across_u, w), dot(u, w));  // z . (u x w) = (z x u) . w
    const Vector<D> at_a = (-1.0 / dot(u, u)) * across_u, at_c = (1.0 / dot(w, w)) * cross(z, w);
    const double rate = dot(at_a, difference<D>(v, spring.a, spring.b)) +
                        dot(at_c, difference<D>(v, spring.c, spring.d));
    const double excess = std::remainder(angle - spring.angle, 2.0 * std::numbers::pi);
    const double torque = spring.stiffness * excess + spring.damping * rate;
    for (const auto& end : ends(spring)) {
      *gradient = end.in_ab * at_a + end.in_cd * at_c;
      add(-quarter_ * torque, *gradient++, y + end.offset);  // Eq. (11)
    }
  }
}

template <int D>
void Forces<D>::add_couples(const double* x, double* y) const {
  for (const auto& couple : layout_.couples) {
    const Vector<D> w = difference<D>(x, couple.a, couple.b);
    const Vector<D> force = (quarter_ * couple.torque / dot(w, w)) * cross(x + couple.axis, w);
    for (const auto& end : ends(couple)) add(end.in_ab, force, y + end.offset);
  }
}

template <int D>
void Forces<D>::add_tangent(const std::vector<Place<D>>& places, double* T) const {
  const Place<D>* place = places.data();
  auto values = springs_.begin();
  for (const auto& spring : layout_.springs) {
    const auto of = ends(spring);
    const SpringValues& now = *values++;
    const auto fill = [&](int i, int j, double(&S)[D][D]) {
      const double sign = of[i].in_ab * of[j].in_ab;
      for (int row = 0; row < D; ++row) {
        for (int col = 0; col < D; ++col) S[row][col] = sign * now.along * now.e[row] * now.e[col];
        S[row][row] += sign * now.across;
      }
    };
    place = add_blocks<D>(static_cast<int>(of.size()), place, T, fill);
  }
  auto gradients = gradients_.begin();
  for (const auto& spring : layout_.torsion_springs) {
    const auto fill = [&](int i, int j, double(&S)[D][D]) {
      const Vector<D> row_factors = weight(spring) * gradients[i];
      for (int row = 0; row < D; ++row) {
        for (int col = 0; col < D; ++col) S[row][col] = row_factors[row] * gradients[j][col];
      }
    };
    const int count = spring.last - spring.first;
    place = add_blocks<D>(count, place, T, fill);
    gradients += count;
  }
}

template class Forces<2>;
template class Forces<3>;

}  // namespace mbs::csc_umfpack
