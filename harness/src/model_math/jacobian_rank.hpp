// Rank of the constraints' Jacobian, and which constraints depend on others.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "mbs/model.hpp"
#include "model_math/kinematics.hpp"

namespace mbs {

/// Entries below this, in rows of length 1, count as zero for the rank.
inline constexpr double kRankTolerance = 1e-9;

/// Most entries that find_rank() processes before it gives up, about a second; chains of 100 000
/// coordinates take a tenth of that.
inline constexpr long kRankWork = 200'000'000;

struct RowRank {
  int rank = 0;
  std::vector<int> dependent;  ///< rows that depend on the rows before them, ascending
};

/// Rank of a sparse rows x cols matrix whose entries are sorted by row, each row scaled to length 1
/// first. Sparse QR by Givens rotations, row after row in the order given, columns in COLAMD's: a
/// row of which less than kRankTolerance is left depends on those before it [Heath, 1982]. Nothing
/// if that takes more than kRankWork. Throws std::invalid_argument on a non-finite value.
///
/// [Heath, 1982] M. T. Heath, Some extensions of an algorithm for sparse linear least squares
/// problems, SIAM J. Sci. Stat. Comput. 3, 223-237.
std::optional<RowRank> find_rank(int rows, int cols, std::span<const JacobianEntry> entries);

/// The rank alone, of a matrix small enough.
int rank_of(int rows, int cols, std::span<const JacobianEntry> entries);

/// Rank of Phi_q at q and time t, or nothing if that is too much work.
std::optional<int> jacobian_rank(const Model& model, std::span<const double> q, double t = 0.0);

}  // namespace mbs
