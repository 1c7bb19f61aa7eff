// Dense copies of the results of operations.hpp.
#include "operations.hpp"

namespace mbs::ublas_sparse {
namespace {

void copy_dense(const SparseMatrix& A, std::span<double> dense) {
  std::size_t k = 0;
  for (int i = 0; i < static_cast<int>(A.size1()); ++i) {
    for (int j = 0; j < static_cast<int>(A.size2()); ++j) dense[k++] = A(i, j);
  }
}

}  // namespace

template <class Product>
void UblasOperations<Product>::get_jacobian(std::span<double> dense) const {
  copy_dense(matrices_.Phi_q, dense);
}

template <class Product>
void UblasOperations<Product>::get_rank_update(std::span<double> dense) const {
  copy_dense(matrices_.C, dense);
}

template <class Product>
void UblasOperations<Product>::get_sum(std::span<double> dense) const {
  copy_dense(matrices_.T, dense);
}

template class UblasOperations<ExpressionProduct>;
template class UblasOperations<AxpyProduct>;

}  // namespace mbs::ublas_sparse
