// Matrices from a Model, and the rank-k update and the addition as uBLAS expressions.
#include "matrices.hpp"

#include <algorithm>
#include <boost/numeric/ublas/matrix.hpp>  // operation.hpp misses it
#include <boost/numeric/ublas/operation.hpp>

namespace mbs::ublas_sparse {

namespace ublas = boost::numeric::ublas;

SparseMatrix from_entries(int rows, int cols, std::vector<Entry> entries) {
  std::ranges::sort(entries, [](const Entry& x, const Entry& y) {
    return std::pair(x.col, x.row) < std::pair(y.col, y.row);
  });
  SparseMatrix result(rows, cols, static_cast<int>(entries.size()));
  for (const Entry& entry : entries) result.push_back(entry.row, entry.col, entry.value);
  result.complete_index1_data();
  return result;
}

SparseMatrix mass_matrix(const Model& model) {
  std::vector<Entry> entries;
  for (const MassEntry& entry : model.mass()) {
    entries.push_back({entry.row, entry.col, entry.value});
    if (entry.row != entry.col) entries.push_back({entry.col, entry.row, entry.value});
  }
  return from_entries(model.variables(), model.variables(), std::move(entries));
}

SparseMatrix tangent_pattern(const SparseMatrix& M, const SparseMatrix& Phi_q) {
  SparseMatrix ones_M = M, ones_Phi_q = Phi_q;  // sums of ones are never zero
  std::ranges::fill(ones_M.value_data(), 1.0);
  std::ranges::fill(ones_Phi_q.value_data(), 1.0);
  SparseMatrix C(M.size1(), M.size2()), T(M.size1(), M.size2());
  AxpyProduct product(ones_Phi_q);
  product(ones_Phi_q, C);
  add_scaled(ones_M, 1.0, C, T);
  T.complete_index1_data();
  return T;
}

void ExpressionProduct::operator()(const SparseMatrix& Phi_q, SparseMatrix& C) {
  ublas::noalias(C) = ublas::prod(ublas::trans(Phi_q), Phi_q);
}

void AxpyProduct::operator()(const SparseMatrix& Phi_q, SparseMatrix& C) {
  ublas::noalias(transpose_) = ublas::trans(Phi_q);
  ublas::axpy_prod(transpose_, Phi_q, C, true);
}

void add_scaled(const SparseMatrix& M, double s, const SparseMatrix& C, SparseMatrix& T) {
  ublas::noalias(T) = M + s * C;  // Eq. (5)
}

}  // namespace mbs::ublas_sparse
