// The uBLAS types and the matrix operations of a pass, as the library's documentation shows them.
#pragma once

// The type checks of a Debug build compare with dense copies of storage that uBLAS 1.74 cannot
// compile as C++20; its bounds and size checks stay on in Debug and are off wherever NDEBUG is set.
#ifndef BOOST_UBLAS_TYPE_CHECK
#define BOOST_UBLAS_TYPE_CHECK 0
#endif

#include <boost/numeric/ublas/matrix_sparse.hpp>
#include <boost/numeric/ublas/vector.hpp>
#include <utility>
#include <vector>

#include "mbs/model.hpp"

namespace mbs::ublas_sparse {

#ifdef NDEBUG
static_assert(BOOST_UBLAS_CHECK_ENABLE == 0 && BOOST_UBLAS_TYPE_CHECK == 0);
#endif

// std::vector is one of the documented storage arrays, and the one that compiles as C++20.
using Vector = boost::numeric::ublas::vector<double, std::vector<double>>;
/// Compressed columns. Example, [1 0; 2 3]: index1_data() = 0 2 3, index2_data() = 0 1 1,
/// value_data() = 1 2 3. Positions may hold zero; the arrays may be longer than nnz().
using SparseMatrix =
    boost::numeric::ublas::compressed_matrix<double, boost::numeric::ublas::column_major, 0,
                                             std::vector<int>, std::vector<double>>;

struct Entry {
  int row, col;
  double value;
};

/// rows x cols from `entries` in any order, each position once; zeros are stored like any other.
[[nodiscard]] SparseMatrix from_entries(int rows, int cols, std::vector<Entry> entries);
/// All stored positions of A.
[[nodiscard]] std::vector<Entry> to_entries(const SparseMatrix& A);
/// `entries` with those of equal position added up.
[[nodiscard]] std::vector<Entry> sum_equal(std::vector<Entry> entries);

/// M (n x n, kg), both triangles, stored zeros included.
[[nodiscard]] SparseMatrix mass_matrix(const Model& model);

/// Every position that S + s Phi_q^T Phi_q can fill at any values of both; set-up only.
[[nodiscard]] SparseMatrix tangent_pattern(const SparseMatrix& S, const SparseMatrix& Phi_q);

/// Rank-k update as one writes it: C = prod(trans(Phi_q), Phi_q).
class ExpressionProduct {
 public:
  explicit ExpressionProduct(const SparseMatrix&) {}
  /// C (n x n, both triangles) from Phi_q (m x n). C has no position for a value that is exactly
  /// zero. Allocates only if C has to grow.
  void operator()(const SparseMatrix& Phi_q, SparseMatrix& C);
};

/// Rank-k update by uBLAS's product for sparse matrices, axpy_prod, with both factors stored in
/// the order in which it walks: first the transpose as a matrix of its own, then the product.
class AxpyProduct {
 public:
  explicit AxpyProduct(const SparseMatrix& Phi_q)
      : transpose_(Phi_q.size2(), Phi_q.size1(), Phi_q.nnz()) {}
  /// As ExpressionProduct, except that C keeps sums that cancel to zero.
  void operator()(const SparseMatrix& Phi_q, SparseMatrix& C);

 private:
  SparseMatrix transpose_;  // n x m
};

/// Matrix addition T = S + s C (n x n each). T is written anew and has no position for a sum that
/// is exactly zero. Allocates only if T has to grow.
void add_scaled(const SparseMatrix& S, double s, const SparseMatrix& C, SparseMatrix& T);

/// The matrices of Eq. (5), with room for every position they can fill. C = Phi_q^T Phi_q is not
/// the damping matrix: that one and K arrive added to M, as S.
template <class Product>
class TangentMatrices {
 public:
  /// Takes S (n x n) and Phi_q (m x n) with all their positions in place.
  TangentMatrices(const SparseMatrix& S, SparseMatrix jacobian)
      : Phi_q(std::move(jacobian)), T(tangent_pattern(S, Phi_q)), C(T), product_(Phi_q) {}

  /// C = Phi_q^T Phi_q.
  void rank_update() { product_(Phi_q, C); }
  /// T = S + factor C of the last rank_update().
  void add(const SparseMatrix& S, double factor) { add_scaled(S, factor, C, T); }

  SparseMatrix Phi_q, T, C;

 private:
  Product product_;
};

}  // namespace mbs::ublas_sparse
