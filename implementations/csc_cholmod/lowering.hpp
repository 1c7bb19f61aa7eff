// The model's constraints lowered to flat arrays once, so that a step neither searches nor
// branches.
#pragma once

#include <span>
#include <vector>

#include "mbs/model.hpp"

namespace mbs::csc_cholmod {

/// Where the numbers of a model stand in this folder's vectors: the n unknowns in an order of their
/// own, then the coordinates of fixed points. A difference r_a - r_b so reads two entries whether a
/// point is fixed or not; vectors of velocities hold zeros behind the unknowns.
class Coordinates {
 public:
  /// `number[i]` is the place of the model's unknown i.
  Coordinates(const Model& model, std::vector<int> number);

  [[nodiscard]] int unknowns() const { return static_cast<int>(number_.size()); }
  [[nodiscard]] int all() const { return unknowns() + static_cast<int>(constants_.size()); }
  [[nodiscard]] bool is_unknown(int place) const { return place < unknowns(); }
  [[nodiscard]] const std::vector<int>& number() const { return number_; }
  [[nodiscard]] const std::vector<double>& constants() const { return constants_; }  ///< m
  [[nodiscard]] int place(int point, int axis) const { return place_[point * dimension_ + axis]; }

 private:
  int dimension_;
  std::vector<int> number_;
  std::vector<int> place_;  ///< of each axis of each point
  std::vector<double> constants_;
};

/// Squared distances |r_a - r_b|^2, all axes in one run: element axis * count + k of constraint k
/// is q[plus] - q[minus]. Twice that is the Jacobian value of the same index.
struct DistanceBlock {
  int count = 0;
  std::vector<int> plus, minus;        ///< dimension x count
  std::vector<double> squared_length;  ///< count, m^2
};

/// All other dot constraints: u = r_a - r_b and w = r_c - r_d in runs as above. A Jacobian value is
/// of_u * u + of_w * w with factors -1, 0, 1, because points may coincide.
struct DotBlock {
  int count = 0;
  std::vector<int> a, b, c, d;     ///< dimension x count
  std::vector<double> target;      ///< count, m^2
  std::vector<int> source, row;    ///< values: element of u and w; row of the block
  std::vector<double> of_u, of_w;  ///< values
  std::vector<int> value_start;    ///< count + 1
  std::vector<int> left, right;    ///< products: the two values (left <= right), of one row
  std::vector<int> product_start;  ///< count + 1
};

/// Linear constraints by compressed rows; their Jacobian values are constants.
struct LinearBlock {
  int count = 0;
  std::vector<int> start;           ///< count + 1
  std::vector<int> column, row;     ///< terms; row of the block
  std::vector<double> coefficient;  ///< terms
  std::vector<double> target;       ///< count, m
};

/// One stored entry of Phi_q outside the linear rows: plus or minus a Jacobian value. The entries
/// of a row share few values: a distance has 2 x dimension entries and `dimension` values.
struct JacobianEntry {
  int column = 0;
  int value = 0;
  bool negative = false;
};

/// The symbolic part: blocks, and which value stands where in Phi_q. Rows are the distances, then
/// the other dot constraints, then the linear ones.
class LoweredConstraints {
 public:
  LoweredConstraints(const Model& model, const Coordinates& coordinates);

  [[nodiscard]] int rows() const { return distance.count + dot.count + linear.count; }
  /// Row of constraint k of the model.
  [[nodiscard]] int row(int k) const { return row_[k]; }
  /// The entries of a row that is not linear; those of fixed points are left out.
  [[nodiscard]] std::span<const JacobianEntry> entries(int row) const {
    return {entries_.data() + entry_start_[row], entries_.data() + entry_start_[row + 1]};
  }
  /// Number of Jacobian values, those of distances first.
  [[nodiscard]] int values() const {
    return dimension * distance.count + static_cast<int>(dot.source.size());
  }
  /// Number of different products of two Jacobian values of a row, those of distances first.
  [[nodiscard]] int products() const { return first_dot_product() + dot.product_start.back(); }
  /// Index of the product of values i and j of `row`.
  [[nodiscard]] int product(int row, int i, int j) const;

  int dimension;
  DistanceBlock distance;
  DotBlock dot;
  LinearBlock linear;

 private:
  [[nodiscard]] int first_dot_product() const {
    return dimension * (dimension + 1) / 2 * distance.count;
  }
  void add_distances(const Model& model, const Coordinates& coordinates);
  void add_dots(const Model& model, const Coordinates& coordinates);
  void add_dot_values(const DotConstraint& constraint, int k, const Coordinates& coordinates);
  void add_linear(const Model& model, const Coordinates& coordinates);

  std::vector<int> row_;
  std::vector<int> entry_start_{0};
  std::vector<JacobianEntry> entries_;
};

}  // namespace mbs::csc_cholmod
