// Which entries the factors of a symmetric matrix have in a given order.
#pragma once

#include <vector>

#include "storage.hpp"

namespace mbs::csc_klu {

/// The graph of L + L^T in a given order; vertices are places in that order.
struct FilledGraph {
  FilledGraph(const Pattern& pattern, const std::vector<int>& order);

  std::vector<std::vector<int>> earlier, later;  ///< neighbours; the earlier ones ascending
};

}  // namespace mbs::csc_klu
