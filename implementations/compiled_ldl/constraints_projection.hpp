// Constraints<S, D>: right-hand sides of the projections in one sweep. Part of constraints.hpp.
#pragma once

#include <type_traits>

#include "constraints.hpp"

namespace mbs::compiled_ldl {

template <typename S, int D>
void Constraints<S, D>::add_projection(const S* x, const S* v, const S& f, S* y) const {
  constexpr bool kPresent = std::is_same_v<S, float>;
  const S* u = u_.data();
  const S* e = (kPresent ? u_ : earlier_u_).data();
  for (int k = 0; k < pairs_.one; ++k, u += D, e += D) {
    const Pair& pair = pairs_.list[k];
    S sum = S(0.0), square = S(0.0), force[D];
    for (int i = 0; i < D; ++i) sum += e[i] * (x[pair.a + i] - x[pair.b + i]);
    sum *= S(4.0) * f;
    for (int i = 0; i < D; ++i) force[i] = sum * e[i];
    if (v != nullptr) {
      for (int i = 0; i < D; ++i) {
        const S rate = v[pair.a + i] - v[pair.b + i];
        square += rate * rate;
      }
      square *= S(4.0) * f;
      for (int i = 0; i < D; ++i) force[i] += square * u[i];
    }
    for (int i = 0; i < D; ++i) y[pair.a + i] -= force[i];
    if (k >= pairs_.two) continue;
    for (int i = 0; i < D; ++i) y[pair.b + i] += force[i];
  }
  const int behind = quads_.empty() ? 0 : 2 * D;  // where there are none, there are no vectors either
  const S* g = vectors_.data() + behind;
  const S* earlier = (kPresent ? vectors_ : earlier_vectors_).data() + behind;
  for (int k = 0; k < static_cast<int>(quads_.size()); ++k, g += kQuad, earlier += kQuad) {
    const Quad& quad = quads_[k];
    S sum = S(0.0);
    for (int i = 0; i < quad.free; ++i) sum += dot<D>(earlier + i * D, x + quad.points[i].row);
    sum *= f;
    const S term = v == nullptr ? S(0.0) : f * quad_velocity_term(k, v);
    for (int i = 0; i < quad.free; ++i) {
      S* to = y + quad.points[i].row;
      for (int j = 0; j < D; ++j) to[j] -= sum * earlier[i * D + j] + term * g[i * D + j];
    }
  }
  for (const Terms& terms : linear_) {
    S sum = S(0.0);
    for (int i = terms.begin; i < terms.end; ++i) sum += term_coefficients_[i] * x[term_rows_[i]];
    sum *= f;
    for (int i = terms.begin; i < terms.end; ++i) y[term_rows_[i]] -= sum * term_coefficients_[i];
  }
}

}  // namespace mbs::compiled_ldl
