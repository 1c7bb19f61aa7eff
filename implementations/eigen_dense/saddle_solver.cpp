// Dense factorization of the saddle-point matrix of Eq. (12) by two Cholesky factorizations.
#include "saddle_solver.hpp"

#include <algorithm>

#include "rank_update.hpp"

namespace mbs::eigen_dense {

template <typename Scalar>
SaddleSolver<Scalar>::SaddleSolver(Eigen::Index variables, Eigen::Index constraints, Scalar epsilon)
    : epsilon_(epsilon),
      leading_(variables),
      coupling_(Matrix::Zero(variables, constraints)),
      schur_(constraints) {}

template <typename Scalar>
void SaddleSolver<Scalar>::form_schur() {
  Matrix& S = schur_.matrix();
  S.setZero();
  S.diagonal().setConstant(epsilon_);
  transposed_rank_update(coupling_, Scalar(1), S);
}

template <typename Scalar>
bool SaddleSolver<Scalar>::factorize() {
  if (!has_leading_) return false;
  if (coupling_.cols() == 0) return true;
  const Eigen::Index width = slice_width<Scalar>(coupling_.rows());
  for (Eigen::Index k = 0; k < coupling_.cols(); k += width) {
    auto slice = coupling_.middleCols(k, std::min(width, coupling_.cols() - k));
    leading_.matrix().template triangularView<Eigen::Lower>().solveInPlace(slice);
  }
  form_schur();
  if (schur_.factorize()) return true;
  // Where rows depend on each other and ε is below the rounding of S, that may make a pivot
  // negative. An ε of the size of that rounding then serves as well.
  form_schur();
  auto diagonal = schur_.matrix().diagonal();
  const Scalar rounding = Scalar(diagonal.size()) * Eigen::NumTraits<Scalar>::epsilon();
  diagonal.array() += rounding * diagonal.maxCoeff();
  return schur_.factorize();
}

template <typename Scalar>
void SaddleSolver<Scalar>::solve(Vector& x) const {
  const auto L = leading_.matrix().template triangularView<Eigen::Lower>();
  const auto L_S = schur_.matrix().template triangularView<Eigen::Lower>();
  auto upper = x.head(coupling_.rows());
  auto lower = x.tail(coupling_.cols());
  L.solveInPlace(upper);
  if (lower.size() > 0) {
    lower = -lower;
    lower.noalias() += coupling_.transpose() * upper;
    L_S.solveInPlace(lower);
    L_S.adjoint().solveInPlace(lower);
    upper.noalias() -= coupling_ * lower;
  }
  L.adjoint().solveInPlace(upper);
}

template class SaddleSolver<double>;
template class SaddleSolver<float>;

}  // namespace mbs::eigen_dense
