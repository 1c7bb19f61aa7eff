// SmallConstraints<N, D>: values, matrix and forces; right-hand sides of the projections. Part of
// small_constraints.hpp.
#pragma once

#include "small_constraints.hpp"

namespace mbs::compiled_ldl {

template <int N, int D>
template <bool kAssembles>
inline void SmallConstraints<N, D>::finish(int number, double phi, double change,
                                           const Row& gradient, Row& y) {
  const double force = lambda[number] + change * phi;
  lambda[number] = force;
  if constexpr (kAssembles) y.add(-h_ * (force + alpha_ * phi), gradient);
}

template <int N, int D>
template <bool kAssembles>
inline void SmallConstraints<N, D>::evaluate(const double* q, double change, Matrix& matrix,
                                             Row& y) {
  const double weight = alpha_ * h_;
  for (Distance& c : distances_) {
    Gradient& g = kAssembles ? c.of_matrix : c.last;
    double u[D];
    c.u.of(q, u);
    double at_u[D];
    for (int x = 0; x < D; ++x) g.at_u[x] = at_u[x] = 2.0 * u[x];
    Row row = Row::zero();
    c.u.add_transposed(at_u, row);
    row.put(g.row);
    finish<kAssembles>(c.number, dot<D>(u, u) - values[c.number], change, row, y);
    if constexpr (kAssembles && kInRegisters<N>) {
      matrix.add_square(weight, g.row);
    } else if constexpr (kAssembles) {
      Row scaled = Row::zero();
      scaled.add(weight, row);
      c.u.add_columns(scaled, at_u, matrix);
    }
  }
  for (Product& c : products_) {
    Gradient& g = kAssembles ? c.of_matrix : c.last;
    double u[D], w[D];
    c.u.of(q, u);
    c.w.of(q, w);
    double at_u[D], at_w[D];
    for (int x = 0; x < D; ++x) {
      at_u[x] = at_w[x] = 0.0;
      for (int y = 0; y < D; ++y) at_u[x] += c.B[x][y] * w[y];
      for (int y = 0; y < D; ++y) at_w[x] += c.B[y][x] * u[y];
      g.at_u[x] = at_u[x];
      g.at_w[x] = at_w[x];
    }
    Row row = Row::zero();
    c.u.add_transposed(at_u, row);
    c.w.add_transposed(at_w, row);
    row.put(g.row);
    finish<kAssembles>(c.number, dot<D>(u, at_u) - values[c.number], change, row, y);
    if constexpr (kAssembles && kInRegisters<N>) {
      matrix.add_square(weight, g.row);
    } else if constexpr (kAssembles) {
      Row scaled = Row::zero();
      scaled.add(weight, row);
      c.u.add_columns(scaled, at_u, matrix);
      c.w.add_columns(scaled, at_w, matrix);
    }
  }
  for (const Linear& c : linear_) {
    double sum = 0.0;
    for (int i = c.begin; i < c.end; ++i) sum += term_coefficients_[i] * q[term_rows_[i]];
    finish<kAssembles>(c.number, sum - values[c.number], change, Row::of(c.row), y);
  }
}

template <int N, int D>
inline void SmallConstraints<N, D>::project(const double* x, const double* v,
                                            const Prescribed* prescribed, Row& y) const {
  const double factor = -alpha_ * h_;
  double u[D], w[D];
  const auto given = [&](int number) {
    return prescribed == nullptr ? 0.0 : -prescribed->values[number];
  };
  for (const Distance& c : distances_) {
    c.u.of(x, u);
    y.add(factor * dot<D>(c.of_matrix.at_u, u), c.of_matrix.row);
    if (v == nullptr && prescribed == nullptr) continue;
    double term = given(c.number);
    if (v != nullptr) {
      c.u.of(v, u);
      term += 2.0 * dot<D>(u, u);
    }
    if (prescribed != nullptr) {
      c.u.of(prescribed->points.data(), u);
      term += dot<D>(c.last.at_u, u);
    }
    y.add(factor * term, c.last.row);
  }
  for (const Product& c : products_) {
    c.u.of(x, u);
    c.w.of(x, w);
    y.add(factor * (dot<D>(c.of_matrix.at_u, u) + dot<D>(c.of_matrix.at_w, w)), c.of_matrix.row);
    if (v == nullptr && prescribed == nullptr) continue;
    double term = given(c.number);
    if (v != nullptr) {
      c.u.of(v, u);
      c.w.of(v, w);
      for (int i = 0; i < D; ++i) term += 2.0 * u[i] * dot<D>(c.B[i], w);
    }
    if (prescribed != nullptr) {
      c.u.of(prescribed->points.data(), u);
      c.w.of(prescribed->points.data(), w);
      term += dot<D>(c.last.at_u, u) + dot<D>(c.last.at_w, w);
    }
    y.add(factor * term, c.last.row);
  }
  for (const Linear& c : linear_) {
    double sum = given(c.number);
    for (int i = c.begin; i < c.end; ++i) sum += term_coefficients_[i] * x[term_rows_[i]];
    y.add(factor * sum, c.row);
  }
}

}  // namespace mbs::compiled_ldl
