// Elimination order of the saddle-point matrix.
#pragma once

#include "solver.hpp"

namespace mbs::eigen_sparse {

/// Where the vertices of `pattern` (symmetric, both triangles), `unknowns` and behind them the
/// multipliers, are eliminated: in the order of the unknowns, each multiplier as soon as it may
/// follow, or by minimum degree, whichever takes fewer operations. The solver of the full matrix,
/// SuperLU, gets the first: minimum degree tears its supernodes.
std::vector<int> saddle_order(const SparseMatrix& pattern, int unknowns, const Followers& followers,
                              Triangle triangle);

}  // namespace mbs::eigen_sparse
