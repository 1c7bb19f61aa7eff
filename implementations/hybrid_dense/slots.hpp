// Where the components of points lie: all points in one array, so that loops need not ask which are
// fixed.
#pragma once

#include <vector>

#include "mbs/model.hpp"
#include "vectors.hpp"

namespace mbs::hybrid_dense {

/// q is the n coordinates, zeros up to whole vectors, then the fixed points. So are v, a, and
/// right-hand sides, where nobody reads what fixed points get.
struct Slots {
  explicit Slots(const Model& model) : n(model.variables()), total(padded(n)) {
    for (const Point& point : model.points()) {
      of.push_back(point.is_fixed() ? static_cast<int>(total) : point.offset);
      if (point.is_fixed()) total += model.dimension();
    }
  }
  [[nodiscard]] bool is_fixed(int slot) const { return slot >= n; }

  long n;
  std::vector<int> of;  ///< first slot of each point
  long total;
};

}  // namespace mbs::hybrid_dense
