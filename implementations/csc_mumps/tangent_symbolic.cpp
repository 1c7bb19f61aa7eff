// Set-up of T: union of patterns, schedule of products, constant part.
#include <algorithm>

#include "tangent.hpp"

namespace mbs::csc_mumps {

Tangent::Tangent(const Model& model, const Assembly& assembly, const StepSettings& settings)
    : assembly_(assembly),
      variables_(model.variables()),
      factor_(settings.step * settings.step / 4.0 * settings.penalty) {
  std::vector<Product> products = collect(model);
  std::sort(products.begin(), products.end());
  schedule(products);
  fill_constant(model);
  assembly_.forces().visit_couplings(
      [&](int row, int column) { force_places_.push_back(pattern_.entry(row, column)); });
}

/// All entries of M and K, and all products of Phi_q' Phi_q; those of linear rows as mere entries.
std::vector<Tangent::Product> Tangent::collect(const Model& model) const {
  std::vector<Product> products;
  const auto add = [&](int row, int column, int left, int right) {
    products.push_back({std::int64_t{column} * variables_ + row, left, right});
  };
  for (const MassEntry& entry : model.mass()) add(entry.row, entry.col, -1, -1);
  const ColumnPattern& jacobian = assembly_.jacobian_pattern();
  for (const std::vector<RowEntry>& row : rows_of(jacobian, model.constraints())) {
    for (const RowEntry& i : row) {
      const bool varies = jacobian.row[i.place] < assembly_.linear_row();
      for (const RowEntry& j : row) {
        if (j.column > i.column) break;
        add(i.column, j.column, varies ? i.place : -1, varies ? j.place : -1);
      }
    }
  }
  assembly_.forces().visit_couplings([&](int row, int column) { add(row, column, -1, -1); });
  return products;
}

void Tangent::schedule(const std::vector<Product>& products) {
  pattern_.start.assign(variables_ + 1, 0);
  std::int64_t previous = -1;
  for (const Product& product : products) {
    if (product.entry != previous) {
      ++pattern_.start[product.entry / variables_ + 1];
      pattern_.row.push_back(static_cast<int>(product.entry % variables_));
      previous = product.entry;
    }
    if (product.left < 0) continue;
    const int target = static_cast<int>(pattern_.row.size()) - 1;
    if (target_.empty() || target_.back() != target) {
      target_.push_back(target);
      product_start_.push_back(static_cast<int>(left_.size()));
    }
    left_.push_back(product.left);
    right_.push_back(product.right);
  }
  product_start_.push_back(static_cast<int>(left_.size()));
  for (int j = 0; j < variables_; ++j) pattern_.start[j + 1] += pattern_.start[j];
}

/// M and the products of the linear constraints on the union pattern.
void Tangent::fill_constant(const Model& model) {
  for (auto* values : {&constant_, &update_, &values_}) values->assign(pattern_.row.size(), 0.0);
  for (const MassEntry& mass : model.mass()) {
    constant_[pattern_.entry(mass.row, mass.col)] += mass.value;
  }
  for (const LinearConstraint& linear : model.linear_constraints()) {
    for (const LinearConstraint::Term& i : linear.terms) {
      for (const LinearConstraint::Term& j : linear.terms) {
        if (i.coordinate < j.coordinate) continue;
        constant_[pattern_.entry(i.coordinate, j.coordinate)] +=
            factor_ * i.coefficient * j.coefficient;
      }
    }
  }
}

}  // namespace mbs::csc_mumps
