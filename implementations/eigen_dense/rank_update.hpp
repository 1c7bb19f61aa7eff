// The symmetric product that both kinds of matrix are made of, without memory from the heap.
#pragma once

#include <Eigen/Core>
#include <algorithm>

namespace mbs::eigen_dense {

/// How many vectors of `size` numbers fit one of Eigen's stack buffers: matrices wider than that
/// are given to the blocked kernels in slices, so that the packed operands never go to the heap.
template <typename Scalar>
Eigen::Index slice_width(Eigen::Index size) {
  const Eigen::Index limit = EIGEN_STACK_ALLOCATION_LIMIT / sizeof(Scalar);
  return std::max<Eigen::Index>(8, limit / std::max<Eigen::Index>(1, size) / 8 * 8);
}

/// A (n×n) += factor U Uᵀ in its lower triangle, U (n×depth); the other half is scratch.
template <typename Scalar, typename Derived>
void rank_update(const Eigen::MatrixBase<Derived>& U, Scalar factor, Eigen::MatrixX<Scalar>& A) {
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

}  // namespace mbs::eigen_dense
