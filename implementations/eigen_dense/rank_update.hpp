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
template <typename Scalar>
void rank_update(const Eigen::Ref<const Eigen::MatrixX<Scalar>>& U, Scalar factor,
                 Eigen::MatrixX<Scalar>& A);

/// The same with factor Uᵀ U, U (depth×n).
template <typename Scalar>
void transposed_rank_update(const Eigen::MatrixX<Scalar>& U, Scalar factor,
                            Eigen::MatrixX<Scalar>& A);

}  // namespace mbs::eigen_dense
