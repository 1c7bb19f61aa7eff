// Forces<S, D>: the forces themselves. Part of forces.hpp.
#pragma once

#include "forces.hpp"

namespace mbs::compiled_ldl {

template <typename S, int D>
void Forces<S, D>::turn(const S* z, const S* x, S* y) {
  if constexpr (D == 2) {
    y[0] = -x[1];
    y[1] = x[0];
  } else {
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3, k = (i + 2) % 3;
      y[i] = z[j] * x[k] - z[k] * x[j];
    }
  }
}

template <typename S, int D>
void Forces<S, D>::add(const S* q, const S* v, const S& factor, S* y) {
  for (int k = 0; k < springs_.count(); ++k) add_spring(q, v, factor, y, k);
  for (int k = 0; k < static_cast<int>(torsions_.size()); ++k) add_torsion(q, v, factor, y, k);
  for (const Couple2& couple : couples_) add_couple(q, factor, y, couple);
}

template <typename S, int D>
void Forces<S, D>::add_spring(const S* q, const S* v, const S& factor, S* y, int k) {
  const Pair& pair = springs_.list[k];
  const Element& spring = spring_[k];
  S* e = direction_.data() + k * D;
  S rate[D];
  for (int i = 0; i < D; ++i) e[i] = q[pair.a + i] - q[pair.b + i];
  for (int i = 0; i < D; ++i) rate[i] = v[pair.a + i] - v[pair.b + i];
  const S length = each(dot<D>(e, e), [](auto x) { return std::sqrt(x); });
  const S inverse = each(length, [](auto x) { return x == 0 ? x : 1 / x; });
  for (int i = 0; i < D; ++i) e[i] *= inverse;
  const S force =
      factor * (spring.stiffness * (length - spring.free) + spring.damping * dot<D>(e, rate));
  across_[k] = larger(S(0.0), spring.stiffness * (S(1.0) - spring.free * inverse));
  for (int i = 0; i < D; ++i) {
    y[pair.a + i] -= force * e[i];
    y[pair.b + i] += force * e[i];
  }
}

template <typename S, int D>
void Forces<S, D>::add_torsion(const S* q, const S* v, const S& factor, S* y, int k) {
  const Quad& quad = torsions_[k];
  const Element& spring = torsion_[k];
  const S* z = q + torsion_axes_[k];
  S* at_a = torsion_directions_.data() + k * 2 * D;
  S* at_c = at_a + D;
  S u[D], w[D];
  for (int i = 0; i < D; ++i) u[i] = q[quad.a + i] - q[quad.b + i];
  for (int i = 0; i < D; ++i) w[i] = q[quad.c + i] - q[quad.d + i];
  turn(z, u, at_a);
  turn(z, w, at_c);
  // z · (u × w) = (z × u) · w
  const S angle =
      each(dot<D>(at_a, w), dot<D>(u, w), [](auto s, auto c) { return std::atan2(s, c); });
  const S turned = each(angle - spring.free, [](auto x) {
    return std::remainder(x, static_cast<decltype(x)>(6.283185307179586476925286766559L));
  });
  const S inverse_u = S(1.0) / dot<D>(u, u), inverse_w = S(1.0) / dot<D>(w, w);
  S rate = S(0.0);
  for (int i = 0; i < D; ++i) {
    at_a[i] *= -inverse_u;
    at_c[i] *= inverse_w;
    rate += at_a[i] * (v[quad.a + i] - v[quad.b + i]) + at_c[i] * (v[quad.c + i] - v[quad.d + i]);
  }
  const S torque = factor * (spring.stiffness * turned + spring.damping * rate);
  for (int i = 0; i < D; ++i) {
    y[quad.a + i] -= torque * at_a[i];
    y[quad.b + i] += torque * at_a[i];
    y[quad.c + i] -= torque * at_c[i];
    y[quad.d + i] += torque * at_c[i];
  }
}

template <typename S, int D>
void Forces<S, D>::add_couple(const S* q, const S& factor, S* y, const Couple2& couple) const {
  S w[D], turned[D];
  for (int i = 0; i < D; ++i) w[i] = q[couple.a + i] - q[couple.b + i];
  turn(q + couple.axis, w, turned);
  const S force = factor * couple.torque / dot<D>(w, w);
  for (int i = 0; i < D; ++i) {
    y[couple.a + i] += force * turned[i];
    y[couple.b + i] -= force * turned[i];
  }
}

}  // namespace mbs::compiled_ldl
