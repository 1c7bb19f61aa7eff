// The largest absolute entry of a vector.
#pragma once

#include <Eigen/Core>
#include <cmath>

namespace mbs::eigen_dense {

/// max|x|, 0 if x is empty, NaN if x has a NaN: no comparison `largest(x) <= bound` is then true.
template <typename Derived>
typename Derived::Scalar largest(const Eigen::MatrixBase<Derived>& x) {
  typename Derived::Scalar result = 0;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const typename Derived::Scalar size = std::abs(x[i]);
    if (size > result || size != size) result = size;
  }
  return result;
}

}  // namespace mbs::eigen_dense
