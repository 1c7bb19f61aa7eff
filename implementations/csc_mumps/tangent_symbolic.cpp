// Set-up of M and T: union of patterns, schedule of products, constant part.
#include <algorithm>
#include <utility>

#include "assembly_builder.hpp"

namespace mbs::csc_mumps {

void Assembly::Builder::build_mass() {
  self_.mass_pattern_.start.assign(self_.variables_ + 1, 0);
  for (const MassEntry& entry : model_.mass()) {
    ++self_.mass_pattern_.start[entry.col + 1];
    self_.mass_pattern_.row.push_back(entry.row);
    self_.mass_.push_back(entry.value);
  }
  for (int j = 0; j < self_.variables_; ++j) {
    self_.mass_pattern_.start[j + 1] += self_.mass_pattern_.start[j];
  }
}

/// Pattern of T as the union of those of M, Phi_q' Phi_q and K, and the schedule of products.
void Assembly::Builder::build_tangent() {
  std::vector<Product> products;
  const auto add = [&](int row, int column, int left, int right) {
    products.push_back({std::int64_t{column} * self_.variables_ + row, left, right});
  };
  for (const MassEntry& entry : model_.mass()) add(entry.row, entry.col, -1, -1);
  std::vector<int> places;
  for (int row = 0; row < static_cast<int>(columns_of_.size()); ++row) {
    const std::vector<int>& columns = columns_of_[row];
    const bool varies = row < self_.linear_row_;
    places.assign(columns.size(), -1);
    for (std::size_t i = 0; i < columns.size(); ++i) {
      if (varies) places[i] = place(row, columns[i]);
      for (std::size_t j = 0; j <= i; ++j) add(columns[i], columns[j], places[i], places[j]);
    }
  }
  for (int row = 0; row < self_.forces_.coupling_rows(); ++row) {
    const std::span<const int> columns = self_.forces_.columns(row);
    for (std::size_t i = 0; i < columns.size(); ++i) {
      for (std::size_t j = 0; j <= i; ++j) add(columns[i], columns[j], -1, -1);
    }
  }
  std::sort(products.begin(), products.end());
  schedule(products);
  fill_constant();
  locate_forces();
}

void Assembly::Builder::schedule(const std::vector<Product>& products) {
  LowerPattern& pattern = self_.pattern_;
  pattern.start.assign(self_.variables_ + 1, 0);
  std::int64_t previous = -1;
  for (const Product& product : products) {
    if (product.entry != previous) {
      ++pattern.start[product.entry / self_.variables_ + 1];
      pattern.row.push_back(static_cast<int>(product.entry % self_.variables_));
      previous = product.entry;
    }
    if (product.left < 0) continue;
    const int target = static_cast<int>(pattern.row.size()) - 1;
    if (self_.target_.empty() || self_.target_.back() != target) {
      self_.target_.push_back(target);
      self_.product_start_.push_back(static_cast<int>(self_.left_.size()));
    }
    self_.left_.push_back(product.left);
    self_.right_.push_back(product.right);
  }
  self_.product_start_.push_back(static_cast<int>(self_.left_.size()));
  for (int j = 0; j < self_.variables_; ++j) pattern.start[j + 1] += pattern.start[j];
}

/// M and the products of the linear constraints on the union pattern.
void Assembly::Builder::fill_constant() {
  for (auto* values : {&self_.constant_, &self_.update_, &self_.tangent_}) {
    values->assign(self_.pattern_.row.size(), 0.0);
  }
  std::vector<double>& constant = self_.constant_;
  for (const MassEntry& mass : model_.mass()) constant[entry(mass.row, mass.col)] += mass.value;
  for (const LinearConstraint& linear : model_.linear_constraints()) {
    for (const auto& [i, c_i] : linear.terms) {
      for (const auto& [j, c_j] : linear.terms) {
        if (i >= j) constant[entry(i, j)] += self_.quarter_ * self_.penalty_ * c_i * c_j;
      }
    }
  }
}

void Assembly::Builder::locate_forces() {
  std::vector<int> places;
  for (int row = 0; row < self_.forces_.coupling_rows(); ++row) {
    const std::span<const int> columns = self_.forces_.columns(row);
    for (std::size_t i = 0; i < columns.size(); ++i) {
      for (std::size_t j = 0; j <= i; ++j) places.push_back(entry(columns[i], columns[j]));
    }
  }
  self_.forces_.set_places(std::move(places));
}

/// Where T(row, column), a stored entry, is in the value arrays.
int Assembly::Builder::entry(int row, int column) const {
  const auto first = self_.pattern_.row.begin();
  const auto end = first + self_.pattern_.start[column + 1];
  return static_cast<int>(std::lower_bound(first + self_.pattern_.start[column], end, row) - first);
}

}  // namespace mbs::csc_mumps
