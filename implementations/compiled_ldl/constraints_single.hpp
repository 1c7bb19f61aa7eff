// Constraints<S, D>: one constraint alone, for those that drivers touch. Part of constraints.hpp.
#pragma once

#include "constraints.hpp"

namespace mbs::compiled_ldl {

template <typename S, int D>
bool Constraints<S, D>::touches(int k, const std::vector<int>& point_rows) const {
  const auto is_one = [&](int row) {
    return std::find(point_rows.begin(), point_rows.end(), row) != point_rows.end();
  };
  if (k < pairs_.count()) return is_one(pairs_.list[k].a) || is_one(pairs_.list[k].b);
  const int i = k - pairs_.count();
  if (i >= static_cast<int>(quads_.size())) return false;
  const Quad& quad = quads_[i];
  return is_one(quad.a) || is_one(quad.b) || is_one(quad.c) || is_one(quad.d);
}

template <typename S, int D>
S Constraints<S, D>::product_of(int k, const S* x) const {
  S sum = S(0.0);
  if (k < pairs_.count()) {
    const Pair& pair = pairs_.list[k];
    for (int i = 0; i < D; ++i) sum += u_[k * D + i] * (x[pair.a + i] - x[pair.b + i]);
    return S(2.0) * sum;
  }
  const int at = k - pairs_.count();
  if (at < static_cast<int>(quads_.size())) {
    const Quad& quad = quads_[at];
    const S* a = vectors_.data() + at * kQuad;
    for (int i = 0; i < D; ++i) {
      sum += a[i] * (x[quad.a + i] - x[quad.b + i]) + a[D + i] * (x[quad.c + i] - x[quad.d + i]);
    }
    return sum;
  }
  const Terms& terms = linear_[at - quads_.size()];
  for (int i = terms.begin; i < terms.end; ++i) sum += term_coefficients_[i] * x[term_rows_[i]];
  return sum;
}

template <typename S, int D>
void Constraints<S, D>::add_gradient(int k, const S& t, S* y) const {
  if (k < pairs_.count()) {
    const Pair& pair = pairs_.list[k];
    for (int i = 0; i < D; ++i) {
      const S force = S(2.0) * t * u_[k * D + i];
      y[pair.a + i] += force;
      y[pair.b + i] -= force;
    }
    return;
  }
  const int at = k - pairs_.count();
  if (at < static_cast<int>(quads_.size())) {
    const S* g = vectors_.data() + at * kQuad + 2 * D;
    for (int i = 0; i < quads_[at].free; ++i) {
      for (int x = 0; x < D; ++x) y[quads_[at].points[i].row + x] += t * g[i * D + x];
    }
    return;
  }
  const Terms& terms = linear_[at - quads_.size()];
  for (int i = terms.begin; i < terms.end; ++i) y[term_rows_[i]] += t * term_coefficients_[i];
}

}  // namespace mbs::compiled_ldl
