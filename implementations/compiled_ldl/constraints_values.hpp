// Constraints<S, D>: values alone. Part of constraints.hpp.
#pragma once

#include "constraints.hpp"

namespace mbs::compiled_ldl {

template <typename S, int D>
template <typename Then>
void Constraints<S, D>::values(const S* q, Then then) const {
  int k = 0;
  for (const Pair& pair : pairs_.list) {
    S u[D];
    for (int x = 0; x < D; ++x) u[x] = q[pair.a + x] - q[pair.b + x];
    then(k, dot<D>(u, u) - value_[k]);
    ++k;
  }
  for (std::size_t i = 0; i < quads_.size(); ++i, ++k) {
    const Quad& quad = quads_[i];
    S u[D], w[D], turned[D];
    for (int x = 0; x < D; ++x) u[x] = q[quad.a + x] - q[quad.b + x];
    for (int x = 0; x < D; ++x) w[x] = q[quad.c + x] - q[quad.d + x];
    const int matrix = matrix_of_quad_[i];
    if (matrix >= 0) multiply(matrices_.data() + matrix, w, turned, false);
    then(k, dot<D>(u, matrix >= 0 ? turned : w) - value_[k]);
  }
  for (const Terms& terms : linear_) {
    S sum = S(0.0);
    for (int i = terms.begin; i < terms.end; ++i) sum += term_coefficients_[i] * q[term_rows_[i]];
    then(k, sum - value_[k]);
    ++k;
  }
}

}  // namespace mbs::compiled_ldl
