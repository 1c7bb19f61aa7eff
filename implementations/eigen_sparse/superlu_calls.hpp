// SuperLU's functions by type of the numbers, and its views of matrices.
#pragma once

#include <superlu/slu_ddefs.h>
#include <superlu/slu_sdefs.h>

#include "coordinates.hpp"

namespace mbs::eigen_sparse {

template <class Scalar>
struct SuperluCalls;

template <>
struct SuperluCalls<double> {
  static constexpr Dtype_t kType = SLU_D;
  static constexpr auto factorize = dgstrf;
  static constexpr auto solve_triangular = sp_dtrsv;
};

template <>
struct SuperluCalls<float> {
  static constexpr Dtype_t kType = SLU_S;
  static constexpr auto factorize = sgstrf;
  static constexpr auto solve_triangular = sp_strsv;
};

/// The square `matrix` as SuperLU describes one; `store` is the view of its arrays.
template <class Scalar>
SuperMatrix described(Stype_t storage, const Eigen::SparseMatrix<Scalar>& matrix, void* store) {
  const auto n = static_cast<int>(matrix.cols());
  return {storage, SuperluCalls<Scalar>::kType, SLU_GE, n, n, store};
}

/// Diagonal pivots, nothing printed.
superlu_options_t options_for_diagonal_pivots();

}  // namespace mbs::eigen_sparse
