// The symmetric product that both kinds of matrix are made of, without memory from the heap.
#include "rank_update.hpp"

namespace mbs::eigen_dense {

namespace {

template <typename Scalar, typename Derived>
void update(const Eigen::MatrixBase<Derived>& U, Scalar factor, Eigen::MatrixX<Scalar>& A) {
  /// Up to here Eigen's general product, which does both triangles, beats its rank-k update.
  constexpr Eigen::Index kGeneralProductLimit = 28;
  const Eigen::Index depth = U.cols();
  if (A.rows() <= kGeneralProductLimit && depth > 0) {
    A.noalias() += factor * U * U.transpose();
    return;
  }
  const Eigen::Index width = slice_width<Scalar>(A.rows());
  for (Eigen::Index k = 0; k < depth; k += width) {
    const auto slice = U.middleCols(k, std::min(width, depth - k));
    A.template selfadjointView<Eigen::Lower>().rankUpdate(slice, factor);
  }
}

}  // namespace

template <typename Scalar>
void rank_update(const Eigen::Ref<const Eigen::MatrixX<Scalar>>& U, Scalar factor,
                 Eigen::MatrixX<Scalar>& A) {
  update(U, factor, A);
}

template <typename Scalar>
void transposed_rank_update(const Eigen::MatrixX<Scalar>& U, Scalar factor,
                            Eigen::MatrixX<Scalar>& A) {
  update(U.transpose(), factor, A);
}

template void rank_update(const Eigen::Ref<const Eigen::MatrixXd>&, double, Eigen::MatrixXd&);
template void rank_update(const Eigen::Ref<const Eigen::MatrixXf>&, float, Eigen::MatrixXf&);
template void transposed_rank_update(const Eigen::MatrixXd&, double, Eigen::MatrixXd&);
template void transposed_rank_update(const Eigen::MatrixXf&, float, Eigen::MatrixXf&);

}  // namespace mbs::eigen_dense
