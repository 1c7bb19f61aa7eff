// Dense LU factorization of the saddle-point matrix of Eq. (12), put together.
#include "saddle_lu.hpp"

namespace mbs::eigen_dense {

template <typename Scalar>
SaddleLu<Scalar>::SaddleLu(Eigen::Index variables, Eigen::Index constraints, Scalar epsilon)
    : constraints_(constraints),
      epsilon_(epsilon),
      leading_(Matrix::Zero(variables, variables)),
      whole_(variables + constraints) {}

template <typename Scalar>
bool SaddleLu<Scalar>::factorize() {
  Matrix& matrix = whole_.matrix();
  matrix.topLeftCorner(leading_.rows(), leading_.rows()) = leading_;
  auto corner = matrix.bottomRightCorner(constraints_, constraints_);
  corner.setZero();
  corner.diagonal().setConstant(-epsilon_);
  return whole_.factorize();
}

template class SaddleLu<double>;
template class SaddleLu<float>;

}  // namespace mbs::eigen_dense
