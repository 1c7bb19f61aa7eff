// Small scenes: constraints, Eqs. (7) and (8), each evaluated, assembled and forgotten at once.
#pragma once

#include "elements/blocks.hpp"
#include "scene.hpp"
#include "small/rows.hpp"

namespace mbs::compiled_ldl {

template <int N, int D>
class SmallConstraints {
 public:
  using Row = SmallRow<N>;
  using Matrix = SmallMatrix<N>;

  SmallConstraints(const Model& model, double alpha, double h);

  /// Φ at q, then λ += change Φ. If it assembles, the matrix and y get what Eqs. (5) and (3) have
  /// of constraints, and Φq is kept for the projections.
  template <bool kAssembles>
  [[gnu::always_inline]] void evaluate(const double* q, double change, Matrix& matrix, Row& y);
  /// y −= (Δt²/4) α Φqᵀ (Φq x + t), with Φq of the matrix, all columns of it for x; t = −ṡ or, if
  /// there is v, 2 u̇·B ẇ − s̈. `given`: ṡ or s̈, nullptr if zero.
  void project(const double* x, const double* v, const double* given, Row& y) const;
  /// What linear rows add to the matrix.
  void add_constant(Matrix& matrix) const {
    for (const Linear& linear : linear_) matrix.add_square(alpha_ * h_, linear.row);
  }

  Array<double> lambda, values;  ///< by number

 private:
  struct Gradient {
    double at_u[D], at_w[D];
    alignas(64) double row[Row::kSize];
  };
  struct Distance {
    Difference<N, D> u;
    int number;
    Gradient gradient;
  };
  struct Product {
    Difference<N, D> u, w;
    double B[D][D];
    int number;
    Gradient gradient;
  };
  struct Linear {
    alignas(64) double row[Row::kSize];
    int number, begin, end;
  };
  void add_product(const Model& model, const BilinearConstraint& c, int number);
  /// λ += change Φ; its force.
  [[gnu::always_inline]] double update(int number, double phi, double change) {
    const double force = lambda[number] + change * phi;
    lambda[number] = force;
    return -h_ * (force + alpha_ * phi);
  }

  double alpha_, h_;
  std::vector<Distance> distances_;
  std::vector<Product> products_;
  std::vector<Linear> linear_;
  std::vector<int> term_rows_;
  std::vector<double> term_coefficients_;
};

// Tables made from the model.

template <int N, int D>
void SmallConstraints<N, D>::add_product(const Model& model, const BilinearConstraint& c,
                                         int number) {
  Product product = {};
  product.u = {model, c.a, c.b};
  product.w = {model, c.c, c.d};
  for (int i = 0; i < D; ++i) std::copy_n(c.B[i].begin(), D, product.B[i]);
  product.number = number;
  products_.push_back(product);
}

template <int N, int D>
SmallConstraints<N, D>::SmallConstraints(const Model& model, double alpha, double h)
    : alpha_(alpha), h_(h) {
  int number = 0;
  for (const DotConstraint& c : model.dot_constraints()) {
    values.push_back(c.value);
    if (c.is_distance()) {
      Distance distance = {};
      distance.u = {model, c.a, c.b};
      distance.number = number++;
      distances_.push_back(distance);
      continue;
    }
    BilinearConstraint same = {c.a, c.b, c.c, c.d, {}, c.value, {}};
    for (int x = 0; x < D; ++x) same.B[x][x] = 1.0;
    add_product(model, same, number++);
  }
  for (const BilinearConstraint& c : model.bilinear_constraints()) {
    values.push_back(c.value);
    add_product(model, c, number++);
  }
  for (const LinearConstraint& c : model.linear_constraints()) {
    values.push_back(c.value);
    Linear linear = {};
    linear.number = number++;
    linear.begin = static_cast<int>(term_rows_.size());
    for (const LinearConstraint::Term& term : c.terms) {
      term_rows_.push_back(term.coordinate);
      term_coefficients_.push_back(term.coefficient);
      linear.row[term.coordinate] = term.coefficient;
    }
    linear.end = static_cast<int>(term_rows_.size());
    linear_.push_back(linear);
  }
  lambda.resize(values.size(), 0.0);
}

// Values, matrix and forces; right-hand sides of the projections.

template <int N, int D>
template <bool kAssembles>
inline void SmallConstraints<N, D>::evaluate(const double* q, double change, Matrix& matrix,
                                             Row& y) {
  const double weight = alpha_ * h_;
  for (Distance& c : distances_) {
    double u[D];
    c.u.of(q, u);
    const double force = update(c.number, dot<D>(u, u) - values[c.number], change);
    if constexpr (!kAssembles) continue;
    Gradient& g = c.gradient;
    double at_u[D];
    for (int x = 0; x < D; ++x) g.at_u[x] = at_u[x] = 2.0 * u[x];
    Row row = Row::zero();
    c.u.add_transposed(at_u, row);
    row.put(g.row);
    y.add(force, row);
    if constexpr (kInRegisters<N>) {
      matrix.add_square(weight, g.row);
    } else {
      Row scaled = Row::zero();
      scaled.add(weight, row);
      c.u.add_columns(scaled, at_u, matrix);
    }
  }
  for (Product& c : products_) {
    double u[D], w[D];
    c.u.of(q, u);
    c.w.of(q, w);
    double at_u[D], at_w[D];
    for (int x = 0; x < D; ++x) {
      at_u[x] = at_w[x] = 0.0;
      for (int y = 0; y < D; ++y) at_u[x] += c.B[x][y] * w[y];
      for (int y = 0; y < D; ++y) at_w[x] += c.B[y][x] * u[y];
    }
    const double force = update(c.number, dot<D>(u, at_u) - values[c.number], change);
    if constexpr (!kAssembles) continue;
    Gradient& g = c.gradient;
    std::copy_n(at_u, D, g.at_u);
    std::copy_n(at_w, D, g.at_w);
    Row row = Row::zero();
    c.u.add_transposed(at_u, row);
    c.w.add_transposed(at_w, row);
    row.put(g.row);
    y.add(force, row);
    if constexpr (kInRegisters<N>) {
      matrix.add_square(weight, g.row);
    } else {
      Row scaled = Row::zero();
      scaled.add(weight, row);
      c.u.add_columns(scaled, at_u, matrix);
      c.w.add_columns(scaled, at_w, matrix);
    }
  }
  for (const Linear& c : linear_) {
    double sum = 0.0;
    for (int i = c.begin; i < c.end; ++i) sum += term_coefficients_[i] * q[term_rows_[i]];
    const double force = update(c.number, sum - values[c.number], change);
    if constexpr (kAssembles) y.add(force, Row::of(c.row));
  }
}

template <int N, int D>
inline void SmallConstraints<N, D>::project(const double* x, const double* v, const double* given,
                                            Row& y) const {
  const double factor = -alpha_ * h_;
  double u[D], w[D];
  const auto subtracted = [&](int number) { return given == nullptr ? 0.0 : given[number]; };
  for (const Distance& c : distances_) {
    c.u.of(x, u);
    double rate = dot<D>(c.gradient.at_u, u) - subtracted(c.number);
    if (v != nullptr) {
      c.u.of(v, u);
      rate += 2.0 * dot<D>(u, u);
    }
    y.add(factor * rate, c.gradient.row);
  }
  for (const Product& c : products_) {
    c.u.of(x, u);
    c.w.of(x, w);
    double rate = dot<D>(c.gradient.at_u, u) + dot<D>(c.gradient.at_w, w) - subtracted(c.number);
    if (v != nullptr) {
      c.u.of(v, u);
      c.w.of(v, w);
      for (int i = 0; i < D; ++i) rate += 2.0 * u[i] * dot<D>(c.B[i], w);
    }
    y.add(factor * rate, c.gradient.row);
  }
  for (const Linear& c : linear_) {
    double sum = -subtracted(c.number);
    for (int i = c.begin; i < c.end; ++i) sum += term_coefficients_[i] * x[term_rows_[i]];
    y.add(factor * sum, c.row);
  }
}

}  // namespace mbs::compiled_ldl
