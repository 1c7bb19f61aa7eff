// Orders of elimination: of the saddle-point matrix, and what they take.
#pragma once

#include "solver.hpp"

namespace mbs::eigen_sparse {

/// Where unknowns and multipliers are eliminated: unknown i at position[i] of the unknowns, each
/// multiplier as soon as it may follow.
std::vector<int> interleaved(const std::vector<int>& position, const Followers& followers);

/// That, or minimum degree on the graph of `saddle`, whichever takes fewer operations.
std::vector<int> least_work(const SparseMatrix& saddle, const std::vector<int>& position,
                            const Followers& followers);

/// Those of a factorization and three solves on `pattern` (both triangles), where vertex i is
/// eliminated at position[i].
[[nodiscard]] double operations(const SparseMatrix& pattern, const std::vector<int>& position);

/// The positions 0, 1, ...
std::vector<int> in_place(int size);

/// A matrix that has factors, of `pattern` with vertex i at position[i].
SparseMatrix dominant(const SparseMatrix& pattern, const std::vector<int>& position);

}  // namespace mbs::eigen_sparse
