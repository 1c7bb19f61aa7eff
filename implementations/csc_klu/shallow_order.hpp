// Orders of a symmetric pattern: AMD's, rearranged so that few eliminations wait for one another.
#pragma once

#include <vector>

#include "storage.hpp"

namespace mbs::csc_klu {

/// Which order.
enum class Order {
  shallow,  ///< shallow_order()
  amd,      ///< AMD's as it is
  colamd,   ///< COLAMD's, KLU's other one
};

/// Columns of `pattern` to eliminate first, second, ...
[[nodiscard]] std::vector<int> ordered(const Pattern& pattern, Order order);

/// An order with the fill of AMD's (or less) and the lowest elimination tree that this fill allows
/// [Jess, Kees; Liu], tier by tier. AMD eliminates a chain from one end to the other: every column
/// waits for the one before. Here both ends take turns, and the processor works on two at a time.
///
/// Example, a chain of five: 4 0 3 1 2.
[[nodiscard]] std::vector<int> shallow_order(const Pattern& pattern);

}  // namespace mbs::csc_klu
