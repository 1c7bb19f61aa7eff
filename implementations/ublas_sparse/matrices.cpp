// Matrices from a Model, and the rank-k update and the addition as uBLAS expressions.
#include "matrices.hpp"

#include <algorithm>
#include <boost/numeric/ublas/matrix.hpp>  // operation.hpp misses it
#include <boost/numeric/ublas/operation.hpp>

namespace mbs::ublas_sparse {

namespace ublas = boost::numeric::ublas;

namespace {

bool by_column(const Entry& x, const Entry& y) {
  return std::pair(x.col, x.row) < std::pair(y.col, y.row);
}

}  // namespace

SparseMatrix from_entries(int rows, int cols, std::vector<Entry> entries) {
  std::ranges::sort(entries, by_column);
  SparseMatrix result(rows, cols, static_cast<int>(entries.size()));
  for (const Entry& entry : entries) result.push_back(entry.row, entry.col, entry.value);
  result.complete_index1_data();
  return result;
}

std::vector<Entry> to_entries(const SparseMatrix& A) {
  std::vector<Entry> entries;
  for (int j = 0; j < static_cast<int>(A.size2()); ++j) {
    for (int p = A.index1_data()[j]; p < A.index1_data()[j + 1]; ++p) {
      entries.push_back({A.index2_data()[p], j, A.value_data()[p]});
    }
  }
  return entries;
}

std::vector<Entry> sum_equal(std::vector<Entry> entries) {
  std::ranges::sort(entries, by_column);
  std::vector<Entry> result;
  for (const Entry& entry : entries) {
    if (result.empty() || by_column(result.back(), entry)) {
      result.push_back(entry);
    } else {
      result.back().value += entry.value;
    }
  }
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

SparseMatrix tangent_pattern(const SparseMatrix& S, const SparseMatrix& Phi_q) {
  SparseMatrix ones_S = S, ones_Phi_q = Phi_q;  // sums of ones are never zero
  std::ranges::fill(ones_S.value_data(), 1.0);
  std::ranges::fill(ones_Phi_q.value_data(), 1.0);
  std::vector<Entry> entries = to_entries(ones_Phi_q);  // trans() would take n^2
  for (Entry& entry : entries) std::swap(entry.row, entry.col);
  const SparseMatrix transpose = from_entries(static_cast<int>(Phi_q.size2()),
                                              static_cast<int>(Phi_q.size1()), std::move(entries));
  SparseMatrix C(S.size1(), S.size2()), T(S.size1(), S.size2());
  ublas::axpy_prod(transpose, ones_Phi_q, C, true);
  add_scaled(ones_S, 1.0, C, T);
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

void add_scaled(const SparseMatrix& S, double s, const SparseMatrix& C, SparseMatrix& T) {
  ublas::noalias(T) = S + s * C;  // Eq. (5)
}

}  // namespace mbs::ublas_sparse
