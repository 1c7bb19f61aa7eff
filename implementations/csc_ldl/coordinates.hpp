// Vectors of coordinates as they are stored here: the state in the order of elimination, then what
// is fixed.
#pragma once

#include <utility>
#include <vector>

#include "mbs/model.hpp"

namespace mbs::csc_ldl {

/// Where a coordinate of a point is. Fixed points have places too, behind the n variables, so that
/// no loop asks whether a point is fixed. There positions are constants or driven; velocities,
/// accelerations and all that multiplies matrices is zero there.
///
/// Example: planar, A fixed, B free and eliminated y before x: A is at (2, 3), B at (1, 0).
class Coordinates {
 public:
  /// `state` says where the state has a coordinate of the model.
  Coordinates(const Model& model, std::vector<int> state)
      : dimension(model.dimension()),
        variables(model.variables()),
        total(model.variables()),
        state_(std::move(state)) {
    for (const Point& point : model.points()) {
      first_.push_back(point.is_fixed() ? total : point.offset);
      if (point.is_fixed()) total += model.dimension();
    }
  }

  [[nodiscard]] int operator()(int point, int axis) const {
    const int place = first_[point] + axis;
    return place < variables ? state_[place] : place;
  }
  /// Of a coordinate of the model.
  [[nodiscard]] const std::vector<int>& state() const { return state_; }

  int dimension, variables, total;

 private:
  std::vector<int> state_;
  std::vector<int> first_;  // of a point: in the model's order
};

}  // namespace mbs::csc_ldl
