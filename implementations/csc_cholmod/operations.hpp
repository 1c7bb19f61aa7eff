// Table 2's operations one at a time, over the index lists that the step uses.
#pragma once

#include <span>
#include <vector>

#include "constraints.hpp"
#include "gather.hpp"
#include "lowering.hpp"
#include "mbs/operations.hpp"
#include "pattern.hpp"

namespace mbs::csc_cholmod {

/// Phi_q (rows x n) by compressed columns: spells out the entries that the step leaves implicit as
/// plus or minus one of few Jacobian values.
///
/// Example, one distance between unknowns 0 and 1 on a line, with the value d: column_start =
/// {0, 1, 2}, row = {0, 0}, target = {0, 1}, source = {0, 0}, sign = {1, -1}, value = {d, -d}.
class JacobianMatrix {
 public:
  JacobianMatrix(const LoweredConstraints& lowered, int columns);

  /// Writes the entries that depend on q from the Jacobian values; linear rows are constant.
  void refresh(const double* values);

  [[nodiscard]] const std::vector<int>& column_start() const { return column_start_; }
  [[nodiscard]] const std::vector<int>& row() const { return row_; }
  [[nodiscard]] const std::vector<double>& value() const { return value_; }

 private:
  std::vector<int> column_start_;  ///< n + 1
  std::vector<int> row_;
  std::vector<double> value_;
  std::vector<int> target_, source_;  ///< value_[target] = sign * values[source]
  std::vector<double> sign_;
};

/// The step fuses Phi_q^T Phi_q and M into one sum (PenaltyForm::refresh_matrix); here the product
/// and the addition are apart, each into a matrix on the tangent's pattern, in the same order of
/// unknowns and half, and through the same schedule.
class CscOperations final : public Operations {
 public:
  explicit CscOperations(const Model& model);

  void set_coordinates(std::span<const double> q) override;
  void evaluate_jacobian() override;
  void rank_update() override;
  void add_mass(double factor) override;

  void get_jacobian(std::span<double> dense) const override;
  void get_rank_update(std::span<double> dense) const override;
  void get_sum(std::span<double> dense) const override;

 private:
  CscOperations(const Model& model, const HalfPattern& pattern);
  void expand(const std::vector<double>& values, std::span<double> dense) const;

  Coordinates coordinates_;
  LoweredConstraints lowered_;
  HalfPattern pattern_;
  GatherSchedule schedule_;
  Constraints constraints_;
  JacobianMatrix jacobian_;
  std::vector<int> model_row_;  ///< of each row here: the constraint of the model
  std::vector<double> q_;       ///< all places, m
  std::vector<double> mass_;    ///< on pattern_, as the next three
  std::vector<double> linear_;  ///< the linear rows' constant part of Phi_q^T Phi_q
  std::vector<double> product_;
  std::vector<double> sum_;
  std::vector<double> products_;  ///< summands of Phi_q^T Phi_q
};

}  // namespace mbs::csc_cholmod
