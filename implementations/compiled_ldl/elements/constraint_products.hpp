// Constraints: values and products with the Jacobian. Part of constraints.hpp.
#pragma once

#include "elements/constraints.hpp"

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

// Linear rows.

/// The sums of columns `at` … end - 1 of a strip, times x.
template <typename S, int D>
inline auto Constraints<S, D>::strip_sums(const S* x, int at, int end) const {
  typename Short<S, kRows>::Type even = {}, odd = {};
  const auto term = [&](int column) {
    return load<S, kRows>(strip_values_.data() + column * kRows) * x[strip_columns_[column]];
  };
  for (; at < end; at += 4) {
    even += term(at);
    odd += term(at + 1);
    even += term(at + 2);
    odd += term(at + 3);
  }
  return even + odd;
}

/// y += the transposed columns times s.
template <typename S, int D>
template <typename W>
inline void Constraints<S, D>::add_strip(const W& s, int at, int end, S* y) const {
  const auto term = [&](int column) {
    return load<S, kRows>(strip_values_.data() + column * kRows) * s;
  };
  for (; at < end; at += 4) {
    const int* columns = strip_columns_.data() + at;
    if constexpr (kRows == 4) {
      const W sums = lane_sums(term(at), term(at + 1), term(at + 2), term(at + 3));
#pragma GCC unroll 4
      for (int i = 0; i < 4; ++i) y[columns[i]] += sums[i];
    } else {
      for (int i = 0; i < 4; ++i) {
        const W products = term(at + i);
        for (int r = 0; r < kRows; ++r) y[columns[i]] += products[r];
      }
    }
  }
}

/// then(k, sum) with the coefficients times x of each linear row k.
template <typename S, int D>
template <typename Then>
inline void Constraints<S, D>::linear_sums(const S* x, Then then) const {
  if constexpr (kRows > 1) {
    int at = 0;
    for (const Strip& strip : strips_) {
      const auto sums = strip_sums(x, at, strip.columns_end);
#pragma GCC unroll 4
      for (int i = 0; i < kRows; ++i) then(strip.row + i, sums[i]);
      at = strip.columns_end;
    }
  }
  for (const int i : loose_) then(first_linear() + i, loose_sum(i, x));
}

template <typename S, int D>
inline S Constraints<S, D>::loose_sum(int i, const S* x) const {
  S sum = S(0.0);
  for (int t = linear_[i].begin; t < linear_[i].end; ++t) {
    sum += term_coefficients_[t] * x[term_rows_[t]];
  }
  return sum;
}

template <typename S, int D>
inline void Constraints<S, D>::add_loose(int i, const S& s, S* y) const {
  for (int t = linear_[i].begin; t < linear_[i].end; ++t) {
    y[term_rows_[t]] += s * term_coefficients_[t];
  }
}

/// y += Σ factor(k) times linear row k.
template <typename S, int D>
template <typename Factor>
inline void Constraints<S, D>::add_linear_gradients(Factor factor, S* y) const {
  if constexpr (kRows > 1) {
    int at = 0;
    for (const Strip& strip : strips_) {
      typename Short<S, kRows>::Type s;
      const int k = strip.row;
      if constexpr (kRows == 4) {
        s = decltype(s){factor(k), factor(k + 1), factor(k + 2), factor(k + 3)};
      } else {
        for (int i = 0; i < kRows; ++i) s[i] = factor(k + i);
      }
      add_strip(s, at, strip.columns_end, y);
      at = strip.columns_end;
    }
  }
  for (const int i : loose_) add_loose(i, factor(first_linear() + i), y);
}

/// y += f Φqᵀ (Φq x − given) of linear rows.
template <typename S, int D>
inline void Constraints<S, D>::add_linear_projection(const S* x, const S* given, const S& f,
                                                     S* y) const {
  if constexpr (kRows > 1) {
    int at = 0;
    for (const Strip& strip : strips_) {
      auto s = strip_sums(x, at, strip.columns_end);
      if (given != nullptr) s -= load<S, kRows>(given + strip.row);
      add_strip(s * f, at, strip.columns_end, y);
      at = strip.columns_end;
    }
  }
  for (const int i : loose_) {
    const S sum = loose_sum(i, x);
    add_loose(i, f * (given == nullptr ? sum : sum - given[first_linear() + i]), y);
  }
}

// All of them.

template <typename S, int D>
template <typename Then>
void Constraints<S, D>::evaluate_with(const S* q, S* phi, Then then) {
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
  linear_sums(q, [&](int i, const S& sum) {
    phi[i] = sum - value_[i];
    then(i, phi[i]);
  });
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
    S at_a[D], at_b[D];
    for (int x = 0; x < D; ++x) at_a[x] = y[pair.a + x] + s * u[x];
    for (int x = 0; x < D; ++x) at_b[x] = y[pair.b + x] - s * u[x];
    for (int x = 0; x < D; ++x) y[pair.a + x] = at_a[x];
    for (int x = 0; x < D; ++x) y[pair.b + x] = at_b[x];
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
  add_linear_gradients(factor, y);
}

template <typename S, int D>
void Constraints<S, D>::add_transposed(const S* t, const S& factor, S* y) const {
  add_gradients([&](int k) { return factor * t[k]; }, y);
}

template <typename S, int D>
void Constraints<S, D>::add_forces(const S* lambda, const S* phi, const S& alpha, const S& h,
                                   S* y) const {
  add_gradients([&](int k) { return -h * (lambda[k] + alpha * phi[k]); }, y);
}

/// Half of Φq x of a distance, + u̇·u̇ if there is v.
template <typename S, int D>
inline S Constraints<S, D>::half_pair_rate(int k, const S* x, const S* v) const {
  const Pair& pair = pairs_.list[k];
  const S* u = u_.data() + k * D;
  S sum = S(0.0), square = S(0.0);
  for (int i = 0; i < D; ++i) sum += u[i] * (x[pair.a + i] - x[pair.b + i]);
  if (v == nullptr) return sum;
  for (int i = 0; i < D; ++i) {
    const S rate = v[pair.a + i] - v[pair.b + i];
    square += rate * rate;
  }
  return sum + square;
}

/// Φq x of another quadratic one, + 2 u̇·B ẇ.
template <typename S, int D>
inline S Constraints<S, D>::quad_rate(int i, const S* x, const S* v) const {
  const Quad& quad = quads_[i];
  const S* a = vectors_.data() + i * kQuad;
  S sum = S(0.0);
  for (int j = 0; j < D; ++j) {
    sum += a[j] * (x[quad.a + j] - x[quad.b + j]) + a[D + j] * (x[quad.c + j] - x[quad.d + j]);
  }
  return v == nullptr ? sum : sum + quad_velocity_term(i, v);
}

template <typename S, int D>
template <typename Then>
void Constraints<S, D>::rates(const S* x, const S* v, const S* given, Then then) const {
  const auto less_given = [&](int k, const S& rate) {
    then(k, given == nullptr ? rate : rate - given[k]);
  };
  int k = 0;
  for (; k < pairs_.count(); ++k) less_given(k, S(2.0) * half_pair_rate(k, x, v));
  for (int i = 0; i < static_cast<int>(quads_.size()); ++i) less_given(k++, quad_rate(i, x, v));
  linear_sums(x, less_given);
}

template <typename S, int D>
void Constraints<S, D>::add_projection(const S* x, const S* v, const S* given, const S& f,
                                       S* y) const {
  const S f2 = S(2.0) * f, f4 = S(4.0) * f;
  int k = 0;
  for (; k < pairs_.one; ++k) {
    const Pair& pair = pairs_.list[k];
    const S* u = u_.data() + k * D;
    S s = f4 * half_pair_rate(k, x, v);
    if (given != nullptr) s -= f2 * given[k];
    // All is read before anything is written, which the compiler need not prove then.
    S at_a[D], at_b[D];
    for (int i = 0; i < D; ++i) {
      at_a[i] = y[pair.a + i] + s * u[i];
      at_b[i] = y[pair.b + i] - s * u[i];
    }
    for (int i = 0; i < D; ++i) y[pair.a + i] = at_a[i];
    if (k >= pairs_.two) continue;
    for (int i = 0; i < D; ++i) y[pair.b + i] = at_b[i];
  }
  k = pairs_.count();
  for (int i = 0; i < static_cast<int>(quads_.size()); ++i, ++k) {
    const Quad& quad = quads_[i];
    const S* g = vectors_.data() + i * kQuad + 2 * D;
    S s = f * quad_rate(i, x, v);
    if (given != nullptr) s -= f * given[k];
    for (int p = 0; p < quad.free; ++p) {
      for (int j = 0; j < D; ++j) y[quad.points[p].row + j] += s * g[p * D + j];
    }
  }
  add_linear_projection(x, given, f, y);
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
  linear_sums(q, [&](int i, const S& sum) { then(i, sum - value_[i]); });
}

/// A distance has the numbers u, another quadratic one A and C, a linear one 1.
template <typename S, int D>
template <typename Then>
void Constraints<S, D>::unit_entries(int k, Then then) const {
  if (k < pairs_.count()) {
    const Pair& pair = pairs_.list[k];
    for (int x = 0; x < D && k < pairs_.one; ++x) {
      then(x, pair.a + x, S(2.0));
      if (k < pairs_.two) then(x, pair.b + x, S(-2.0));
    }
    return;
  }
  const int at = k - pairs_.count();
  if (at < static_cast<int>(quads_.size())) {
    for (int i = 0; i < quads_[at].free; ++i) {
      const Quad::Point& point = quads_[at].points[i];
      for (int x = 0; x < D; ++x) {
        then(x, point.row + x, S(point.sign_a));
        then(D + x, point.row + x, S(point.sign_c));
      }
    }
    return;
  }
  const Terms& terms = linear_[at - quads_.size()];
  for (int i = terms.begin; i < terms.end; ++i) then(0, term_rows_[i], term_coefficients_[i]);
}

template <typename S, int D>
template <typename Then>
void Constraints<S, D>::gradient_numbers(Then then) const {
  int k = 0;
  for (; k < pairs_.count(); ++k) {
    for (int x = 0; x < D; ++x) then(k, x, u_[k * D + x]);
  }
  for (std::size_t i = 0; i < quads_.size(); ++i, ++k) {
    for (int x = 0; x < 2 * D; ++x) then(k, x, vectors_[i * kQuad + x]);
  }
  for (; k < count(); ++k) then(k, 0, S(1.0));
}

}  // namespace mbs::compiled_ldl
