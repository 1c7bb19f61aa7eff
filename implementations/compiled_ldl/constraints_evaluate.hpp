// Constraints<S, D>: values and products with the Jacobian. Part of constraints.hpp.
#pragma once

#include "constraints.hpp"

namespace mbs::compiled_ldl {

/// y = B x, or Bᵀ x.
template <typename S, int D>
void Constraints<S, D>::multiply(const S* matrix, const S* x, S* y, bool transposed) const {
  for (int i = 0; i < D; ++i) {
    S sum = S(0.0);
    for (int j = 0; j < D; ++j) sum += matrix[transposed ? j * D + i : i * D + j] * x[j];
    y[i] = sum;
  }
}

template <typename S, int D>
template <typename Then>
void Constraints<S, D>::evaluate_with(const S* q, S* phi, bool exchange, Then then) {
  if (exchange) {
    u_.swap(earlier_u_);
    vectors_.swap(earlier_vectors_);
  }
  int k = 0;
  S* u = u_.data();
  for (const Pair& pair : pairs_.list) {
    for (int x = 0; x < D; ++x) u[x] = q[pair.a + x] - q[pair.b + x];
    phi[k] = dot<D>(u, u) - value_[k];
    then(k, phi[k]);
    u += D;
    ++k;
  }
  S* vectors = vectors_.data();
  for (std::size_t i = 0; i < quads_.size(); ++i, ++k, vectors += kQuad) {
    const Quad& quad = quads_[i];
    S* a = vectors;
    S* c = vectors + D;
    for (int x = 0; x < D; ++x) c[x] = q[quad.a + x] - q[quad.b + x];
    for (int x = 0; x < D; ++x) a[x] = q[quad.c + x] - q[quad.d + x];
    if (matrix_of_quad_[i] >= 0) {
      const S* matrix = matrices_.data() + matrix_of_quad_[i];
      S u_copy[D], w[D];
      for (int x = 0; x < D; ++x) u_copy[x] = c[x];
      for (int x = 0; x < D; ++x) w[x] = a[x];
      multiply(matrix, w, a, false);
      phi[k] = dot<D>(u_copy, a) - value_[k];
      multiply(matrix, u_copy, c, true);
    } else {
      phi[k] = dot<D>(c, a) - value_[k];
    }
    then(k, phi[k]);
    find_gradients<D>(quad, a, c, vectors + 2 * D);
  }
  for (const Terms& terms : linear_) {
    S sum = S(0.0);
    for (int i = terms.begin; i < terms.end; ++i) sum += term_coefficients_[i] * q[term_rows_[i]];
    phi[k] = sum - value_[k];
    then(k, phi[k]);
    ++k;
  }
}

/// y += Σ factor(k) times the gradient of constraint k, at free points.
template <typename S, int D>
template <typename Factor>
void Constraints<S, D>::add_gradients(Factor factor, S* y) const {
  int k = 0;
  const S* u = u_.data();
  for (; k < pairs_.two; ++k, u += D) {
    const Pair& pair = pairs_.list[k];
    const S s = factor(k) * S(2.0);
    for (int x = 0; x < D; ++x) {
      const S force = s * u[x];
      y[pair.a + x] += force;
      y[pair.b + x] -= force;
    }
  }
  for (; k < pairs_.one; ++k, u += D) {
    const Pair& pair = pairs_.list[k];
    const S s = factor(k) * S(2.0);
    for (int x = 0; x < D; ++x) y[pair.a + x] += s * u[x];
  }
  k = pairs_.count();
  const S* g = quads_.empty() ? nullptr : vectors_.data() + 2 * D;
  for (const Quad& quad : quads_) {
    const S s = factor(k++);
    for (int i = 0; i < quad.free; ++i) {
      for (int x = 0; x < D; ++x) y[quad.points[i].row + x] += s * g[i * D + x];
    }
    g += kQuad;
  }
  for (const Terms& terms : linear_) {
    const S s = factor(k++);
    for (int i = terms.begin; i < terms.end; ++i) y[term_rows_[i]] += s * term_coefficients_[i];
  }
}

template <typename S, int D>
void Constraints<S, D>::add_transposed(const S* t, S* y) const {
  add_gradients([t](int k) { return t[k]; }, y);
}

template <typename S, int D>
void Constraints<S, D>::add_forces(const S* lambda, const S* phi, const S& alpha, const S& h,
                                   S* y) const {
  add_gradients([&](int k) { return -h * (lambda[k] + alpha * phi[k]); }, y);
}

template <typename S, int D>
void Constraints<S, D>::product(const S* x, S* t, bool earlier) const {
  int k = 0;
  const S* u = (earlier ? earlier_u_ : u_).data();
  for (const Pair& pair : pairs_.list) {
    S sum = S(0.0);
    for (int i = 0; i < D; ++i) sum += u[i] * (x[pair.a + i] - x[pair.b + i]);
    t[k++] = sum * S(2.0);
    u += D;
  }
  const S* vectors = (earlier ? earlier_vectors_ : vectors_).data();
  for (const Quad& quad : quads_) {
    S sum = S(0.0);
    for (int i = 0; i < D; ++i) {
      sum += vectors[i] * (x[quad.a + i] - x[quad.b + i]) +
             vectors[D + i] * (x[quad.c + i] - x[quad.d + i]);
    }
    t[k++] = sum;
    vectors += kQuad;
  }
  for (const Terms& terms : linear_) {
    S sum = S(0.0);
    for (int i = terms.begin; i < terms.end; ++i) sum += term_coefficients_[i] * x[term_rows_[i]];
    t[k++] = sum;
  }
}

template <typename S, int D>
void Constraints<S, D>::velocity_terms(const S* v, S* t) const {
  int k = 0;
  for (const Pair& pair : pairs_.list) {
    S rate[D];
    for (int x = 0; x < D; ++x) rate[x] = v[pair.a + x] - v[pair.b + x];
    t[k++] = S(2.0) * dot<D>(rate, rate);
  }
  for (int i = 0; i < static_cast<int>(quads_.size()); ++i) t[k++] = quad_velocity_term(i, v);
  while (k < count()) t[k++] = S(0.0);
}

template <typename S, int D>
S Constraints<S, D>::quad_velocity_term(int i, const S* v) const {
  const Quad& quad = quads_[i];
  S u[D], w[D], turned[D];
  for (int x = 0; x < D; ++x) u[x] = v[quad.a + x] - v[quad.b + x];
  for (int x = 0; x < D; ++x) w[x] = v[quad.c + x] - v[quad.d + x];
  if (matrix_of_quad_[i] < 0) return S(2.0) * dot<D>(u, w);
  multiply(matrices_.data() + matrix_of_quad_[i], w, turned, false);
  return S(2.0) * dot<D>(u, turned);
}

}  // namespace mbs::compiled_ldl
