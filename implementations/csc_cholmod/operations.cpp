// Set-up from the step's own symbolic classes, then three loops over flat arrays.
#include "operations.hpp"

#include <algorithm>
#include <cstddef>

#include "schedule.hpp"
#include "solver.hpp"

namespace mbs::csc_cholmod {
namespace {

/// An entry of Phi_q at set-up; `source` is -1 for a constant.
struct Entry {
  int column = 0;
  int row = 0;
  int source = -1;
  double factor = 0.0;  // the sign, or the constant
};

std::vector<Entry> entries_by_columns(const LoweredConstraints& lowered) {
  std::vector<Entry> result;
  const SignedRows& rows = lowered.entries();
  for (int row = 0; row < rows.rows(); ++row) {
    for (const SignedEntry& e : rows[row]) {
      result.push_back({e.column, row, e.value, e.negative ? -1.0 : 1.0});
    }
  }
  const LinearBlock& linear = lowered.linear;
  for (std::size_t t = 0; t < linear.column.size(); ++t) {
    result.push_back({linear.column[t], linear.row[t], -1, linear.coefficient[t]});
  }
  std::stable_sort(result.begin(), result.end(),
                   [](const Entry& a, const Entry& b) { return a.column < b.column; });
  return result;
}

}  // namespace

JacobianMatrix::JacobianMatrix(const LoweredConstraints& lowered, int columns)
    : column_start_(columns + 1) {
  for (const Entry& e : entries_by_columns(lowered)) {
    if (e.source >= 0) {
      target_.push_back(static_cast<int>(row_.size()));
      source_.push_back(e.source);
      sign_.push_back(e.factor);
    }
    row_.push_back(e.row);
    value_.push_back(e.factor);
    ++column_start_[e.column + 1];
  }
  for (int j = 0; j < columns; ++j) column_start_[j + 1] += column_start_[j];
}

void JacobianMatrix::refresh(const double* __restrict values) {
  double* __restrict value = value_.data();
  for (std::size_t e = 0; e < target_.size(); ++e) {
    value[target_[e]] = sign_[e] * values[source_[e]];
  }
}

CscOperations::CscOperations(const Model& model) : CscOperations(model, tangent_pattern(model)) {}

CscOperations::CscOperations(const Model& model, const HalfPattern& pattern)
    : coordinates_(model, fill_reducing_order(pattern, {Factorization::simplicial})),
      lowered_(model, coordinates_),
      pattern_(
          pattern.renumbered(preferred_half(Factorization::simplicial), coordinates_.number())),
      schedule_(tangent_contributions(lowered_, pattern_)),
      constraints_(lowered_),
      jacobian_(lowered_, model.variables()),
      model_row_(model.constraints()),
      q_(coordinates_.all()),
      mass_(mass_values(model, pattern_, coordinates_.number())),
      linear_(pattern_.nonzeros()),
      sum_(pattern_.nonzeros()),
      products_(2 * lowered_.products()) {
  for (int k = 0; k < model.constraints(); ++k) model_row_[lowered_.row(k)] = k;
  const std::vector<double>& constants = coordinates_.constants();
  std::copy(constants.begin(), constants.end(), q_.begin() + model.variables());
  add_linear_products(lowered_.linear, pattern_, 1.0, linear_);
  product_ = linear_;
}

void CscOperations::set_coordinates(std::span<const double> q) {
  for (std::size_t i = 0; i < q.size(); ++i) q_[coordinates_.number()[i]] = q[i];
}

void CscOperations::evaluate_jacobian() {
  constraints_.take(q_.data());
  constraints_.evaluate_jacobian();  // Eqs. (7), (8)
  jacobian_.refresh(constraints_.values());
}

void CscOperations::rank_update() {
  constraints_.multiply_pairs(1.0, products_.data());
  schedule_.sum(linear_.data(), products_.data(), product_.data());
}

void CscOperations::add_mass(double factor) {
  const double* __restrict mass = mass_.data();
  const double* __restrict product = product_.data();
  double* __restrict sum = sum_.data();
  for (std::size_t p = 0; p < sum_.size(); ++p) sum[p] = mass[p] + factor * product[p];  // Eq. (5)
}

void CscOperations::get_jacobian(std::span<double> dense) const {
  std::fill(dense.begin(), dense.end(), 0.0);
  const std::size_t n = coordinates_.number().size();
  for (std::size_t i = 0; i < n; ++i) {
    const int column = coordinates_.number()[i];
    for (int p = jacobian_.column_start()[column]; p < jacobian_.column_start()[column + 1]; ++p) {
      dense[model_row_[jacobian_.row()[p]] * n + i] = jacobian_.value()[p];
    }
  }
}

void CscOperations::get_rank_update(std::span<double> dense) const { expand(product_, dense); }

void CscOperations::get_sum(std::span<double> dense) const { expand(sum_, dense); }

void CscOperations::expand(const std::vector<double>& values, std::span<double> dense) const {
  std::fill(dense.begin(), dense.end(), 0.0);
  const std::size_t n = coordinates_.number().size();
  std::vector<std::size_t> unknown(n);  // of the model, for each place
  for (std::size_t i = 0; i < n; ++i) unknown[coordinates_.number()[i]] = i;
  for (std::size_t j = 0; j < n; ++j) {
    for (int p = pattern_.column_start()[j]; p < pattern_.column_start()[j + 1]; ++p) {
      const std::size_t row = unknown[pattern_.row()[p]];
      dense[row * n + unknown[j]] = dense[unknown[j] * n + row] = values[p];
    }
  }
}

}  // namespace mbs::csc_cholmod
