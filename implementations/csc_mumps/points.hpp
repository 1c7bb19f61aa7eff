// Where the points of a model are in an extended vector; needed at set-up only.
#pragma once

#include <initializer_list>
#include <vector>

#include "mbs/model.hpp"

namespace mbs::csc_mumps {

/// An *extended* vector holds the n variables and behind them `dimension` numbers for each fixed
/// point, driven ones included. So all points are alike to the loops.
///
/// Example, planar: A fixed, B and C free give n = 4 and the offsets 4, 0, 2.
struct ExtendedPoints {
  explicit ExtendedPoints(const Model& model);

  [[nodiscard]] bool is_free(int place) const { return place < variables; }
  /// Columns of the free ones of `points` (indices into Model::points()), ascending, each once.
  [[nodiscard]] std::vector<int> columns(std::initializer_list<int> points) const;

  int variables = 0, dimension = 0;
  std::vector<int> offset;    ///< of each point
  std::vector<double> fixed;  ///< coordinates of the fixed points: the end of an extended q
};

}  // namespace mbs::csc_mumps
