// SmallConstraints<N, D>: tables made from the model. Part of small_constraints.hpp.
#pragma once

#include "small_constraints.hpp"

namespace mbs::compiled_ldl {

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
    if (c.a == c.c && c.b == c.d) {
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

}  // namespace mbs::compiled_ldl
