// The model's constraints lowered to flat arrays once, so that a step neither searches nor
// branches.
#pragma once

#include <vector>

#include "coordinates.hpp"
#include "entries.hpp"
#include "mbs/model.hpp"
#include "pair_block.hpp"

namespace mbs::csc_cholmod {

/// Squared distances |r_a - r_b|^2, all axes in one run: element axis * count + k of constraint k
/// is q[plus] - q[minus]. Twice that is the Jacobian value of the same index.
struct DistanceBlock {
  int count = 0;
  std::vector<int> plus, minus;  ///< dimension x count
};

/// Linear constraints by compressed rows; their Jacobian values are constants.
struct LinearBlock {
  int first_row = 0;
  int count = 0;
  std::vector<int> start;           ///< count + 1
  std::vector<int> column, row;     ///< terms; row of Phi
  std::vector<double> coefficient;  ///< terms
};

/// The symbolic part: blocks, and which value stands where in Phi_q. Rows are the distances, the
/// other dot constraints, the bilinear and then the linear ones.
class LoweredConstraints {
 public:
  LoweredConstraints(const Model& model, const Coordinates& coordinates);

  [[nodiscard]] int rows() const { return static_cast<int>(row_.size()); }
  /// Row of constraint k of the model.
  [[nodiscard]] int row(int k) const { return row_[k]; }
  /// The rows that are not linear.
  [[nodiscard]] const SignedRows& entries() const { return entries_; }
  /// Number of Jacobian values, those of distances first.
  [[nodiscard]] int values() const { return next_.value; }
  /// Number of different products of two Jacobian values of a row, those of distances first.
  [[nodiscard]] int products() const { return next_.product; }
  /// Index of the product of values i and j of `row`.
  [[nodiscard]] int product(int row, int i, int j) const;

  int dimension;
  DistanceBlock distance;
  std::vector<PairBlock> pairs;  ///< those that the model has
  LinearBlock linear;
  std::vector<double> target;  ///< rows, m^2 or m: the constant s of each

 private:
  void number_rows(const Model& model);
  void add_distances(const Model& model, const Coordinates& coordinates);
  void add_pairs(const std::vector<PairConstraint>& constraints, const Coordinates& coordinates);
  void add_linear(const Model& model, const Coordinates& coordinates);

  std::vector<int> row_;
  PairBlock::First next_;  ///< row, value and product not given away yet
  SignedRows entries_;
};

}  // namespace mbs::csc_cholmod
