// Dense LU factorization with partial pivoting of the saddle-point matrix of Eq. (12), in float.
#include "saddle_lu.hpp"

#include <cmath>

namespace mbs::eigen_dense {

SaddleLu::SaddleLu(Eigen::Index variables, Eigen::Index constraints, float epsilon)
    : constraints_(constraints),
      epsilon_(epsilon),
      leading_(Matrix::Zero(variables, variables)),
      matrix_(Matrix::Identity(variables + constraints, variables + constraints)),
      lu_(matrix_),
      solution_(Vector::Zero(variables + constraints)) {}

bool SaddleLu::factorize() {
  const Eigen::Index n = leading_.rows();
  matrix_.topLeftCorner(n, n) = leading_.selfadjointView<Eigen::Lower>();
  matrix_.bottomLeftCorner(constraints_, n) = coupling().transpose();
  auto corner = matrix_.bottomRightCorner(constraints_, constraints_);
  corner.setZero();
  corner.diagonal().setConstant(-epsilon_);
  lu_.compute(matrix_);
  const auto pivots = matrix_.diagonal();
  return std::isfinite(pivots.sum()) && (pivots.array() != 0.0F).all();
}

void SaddleLu::solve(Vector& x) {
  solution_ = lu_.solve(x);
  x = solution_;
}

}  // namespace mbs::eigen_dense
