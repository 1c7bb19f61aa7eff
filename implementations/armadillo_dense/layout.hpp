// Where each point's numbers are in extended vectors.
#pragma once

#include <algorithm>
#include <armadillo>
#include <array>
#include <vector>

#include "mbs/model.hpp"

namespace mbs::armadillo_dense {

/// *Extended* vectors hold the n entries of q (or v, a), then `dimension` numbers for each driven
/// point, then for each fixed one, so that a fixed or driven point is read like a free one.
///
/// Example, planar: A fixed, B free. Positions are (Bx, By, Ax, Ay), starts of A and B are 2 and 0.
struct Layout {
  explicit Layout(const Model& model);

  [[nodiscard]] bool is_free(int start) const { return start < n; }
  /// Extended vectors with their constants set: points at t = 0, and zeros.
  [[nodiscard]] arma::vec positions(const Model& model) const;
  [[nodiscard]] arma::vec zeros() const { return arma::vec(size, arma::fill::zeros); }

  /// Moves the distinct starts of free points in `at` to its front, ascending; how many they are.
  template <std::size_t count>
  [[nodiscard]] int distinct_free(std::array<int, count>& at) const {
    std::sort(at.begin(), at.end());
    const auto last = std::unique(at.begin(), at.end());
    return static_cast<int>(std::lower_bound(at.begin(), last, n) - at.begin());
  }

  int n;                    ///< variables
  int dimension;            ///< 2 or 3
  int moving;               ///< the first entries of extended vectors: of free and driven points
  int size;                 ///< of extended vectors
  std::vector<int> starts;  ///< of each point in extended vectors; below n if it is free
};

}  // namespace mbs::armadillo_dense
