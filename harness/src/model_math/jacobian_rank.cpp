// Rank-revealing QR by Eigen.
#include "model_math/jacobian_rank.hpp"

#include <Eigen/Dense>
#include <cmath>
#include <stdexcept>

namespace mbs {

int rank_of(int rows, int cols, std::span<const JacobianEntry> entries) {
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(rows, cols);
  for (const JacobianEntry& entry : entries) {
    if (!std::isfinite(entry.value)) throw std::invalid_argument("rank of a non-finite matrix");
    matrix(entry.row, entry.col) = entry.value;
  }
  if (matrix.size() == 0) return 0;
  for (int row = 0; row < rows; ++row) {
    const double norm = matrix.row(row).stableNorm();
    if (norm > 0.0) matrix.row(row) /= norm;
  }
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr;
  qr.setThreshold(1e-9);
  qr.compute(matrix);
  return static_cast<int>(qr.rank());
}

std::optional<int> jacobian_rank(const Model& model, std::span<const double> q) {
  if (model.variables() > kDenseRankLimit || model.constraints() > 2 * kDenseRankLimit) {
    return std::nullopt;
  }
  return rank_of(model.constraints(), model.variables(), jacobian(model, q));
}

}  // namespace mbs
