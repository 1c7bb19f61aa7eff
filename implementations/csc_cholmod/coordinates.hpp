// Where the numbers of a model stand in this folder's vectors.
#pragma once

#include <array>
#include <vector>

#include "mbs/model.hpp"

namespace mbs::csc_cholmod {

/// Places of three components; in the plane the third is a constant.
using Places = std::array<int, 3>;

/// The n unknowns in an order of their own, then constants: 0 and 1, then the coordinates of fixed
/// points. A difference r_a - r_b so reads two entries whether a point is fixed or not; vectors of
/// velocities and accelerations hold zeros behind the unknowns, but for driven points.
class Coordinates {
 public:
  /// `number[i]` is the place of the model's unknown i.
  Coordinates(const Model& model, std::vector<int> number);

  [[nodiscard]] int dimension() const { return dimension_; }
  [[nodiscard]] int unknowns() const { return static_cast<int>(number_.size()); }
  [[nodiscard]] int all() const { return unknowns() + static_cast<int>(constants_.size()); }
  [[nodiscard]] bool is_unknown(int place) const { return place < unknowns(); }
  [[nodiscard]] const std::vector<int>& number() const { return number_; }
  [[nodiscard]] const std::vector<double>& constants() const { return constants_; }  ///< m

  /// The place that holds zero, the first behind the unknowns.
  [[nodiscard]] int zero() const { return unknowns(); }
  [[nodiscard]] int place(int point, int axis) const { return place_[point * dimension_ + axis]; }
  [[nodiscard]] Places places(int point) const;
  /// Of an axis to turn about; -1 is (0, 0, 1).
  [[nodiscard]] Places axis_places(int point) const;

 private:
  int dimension_;
  std::vector<int> number_;
  std::vector<int> place_;  ///< of each axis of each point
  std::vector<double> constants_{0.0, 1.0};
};

}  // namespace mbs::csc_cholmod
