// Rank of the constraints' Jacobian, by dense factorization where that is affordable.
#pragma once

#include <optional>
#include <span>

#include "mbs/model.hpp"
#include "model_math/kinematics.hpp"

namespace mbs {

/// Most coordinates for which jacobian_rank() factorizes (twice as many constraints): some 50 ms.
inline constexpr int kDenseRankLimit = 400;

/// Rank of a rows x cols matrix, each row scaled to length 1 first: pivots of a QR factorization
/// with column pivoting below 1e-9 of the largest count as zero. Throws std::invalid_argument on a
/// non-finite value.
int rank_of(int rows, int cols, std::span<const JacobianEntry> entries);

/// Rank of Phi_q(q), or nothing if the model is beyond kDenseRankLimit.
std::optional<int> jacobian_rank(const Model& model, std::span<const double> q);

}  // namespace mbs
