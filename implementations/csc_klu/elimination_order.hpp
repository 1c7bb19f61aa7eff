// In which order to eliminate the saddle-point matrix, found once.
#pragma once

#include <vector>

#include "shallow_order.hpp"
#include "storage.hpp"

namespace mbs::csc_klu {

/// Coordinates that a row owns: `count` from `first` on.
struct Owned {
  int first = 0, count = 0;
};

/// An order for the matrix of Eq. (12) on `saddle`, n coordinates before its multipliers, in which
/// every multiplier comes after all of its coordinates. So it never is -eps alone that becomes a
/// pivot, by which 1/eps Phi_q^T Phi_q would come into T_0 as it does in the penalty form, but
/// -(eps + Phi_q S^-1 Phi_q^T) with the row of the constraint whole.
///
/// Example, one coordinate x and one multiplier: x, then the multiplier.
/// But a row may own some of its coordinates, and waits for these only. To a row that has an
/// owned coordinate, those of its owner count as its own.
///
/// Of two such orders, the one that leaves less work: T's for the coordinates, with each multiplier
/// as soon as it may come; and minimum degree on the graph of coordinates and multipliers. With
/// another `order` of T than shallow_order()'s: the first.
[[nodiscard]] std::vector<int> saddle_order(const Pattern& saddle, int n,
                                            const std::vector<Owned>& owned, Order order);

}  // namespace mbs::csc_klu
