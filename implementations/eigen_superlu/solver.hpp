// The two factorizations behind one interface: Eigen's simplicial LDL^T and SuperLU.
#pragma once

#include <Eigen/SparseCholesky>
#include <memory>
#include <string>
#include <vector>

#include "coordinates.hpp"

namespace mbs::eigen_superlu {

/// Which part of the symmetric tangent matrix a solver wants stored.
enum class Triangle { upper, full };

/// L D L^T by Eigen::SimplicialLDLT. The unknowns already are in elimination order, so Eigen is
/// told to keep it and reads the upper triangle in place; the derived class reaches the part of
/// factorize() behind Eigen's permutation and copies.
class SimplicialSolver {
 public:
  static constexpr Triangle kTriangle = Triangle::upper;
  /// AMD: position[i] is where unknown i of `pattern` (n x n, both triangles) is eliminated.
  [[nodiscard]] static std::vector<int> elimination_order(const SparseMatrix& pattern);

  /// Symbolic analysis. `tangent` outlives the solver; its values may change, its pattern not.
  explicit SimplicialSolver(const SparseMatrix& tangent);
  /// Factorizes the present values; false unless all pivots are positive numbers.
  [[nodiscard]] bool factorize();
  /// Overwrites x (n) by the solution, with the last successful factorization.
  void solve(Vector& x) const;

 private:
  using Factors = Eigen::SimplicialLDLT<SparseMatrix, Eigen::Upper, Eigen::NaturalOrdering<int>>;
  struct Preordered : Factors {
    void refactorize(const SparseMatrix& matrix) { factorize_preordered<true>(matrix); }
    [[nodiscard]] const Vector& pivots() const { return m_diag; }
  };

  const SparseMatrix& tangent_;
  Preordered factors_;
};

/// T = L U by SuperLU with diagonal pivots; the same contract as SimplicialSolver.
class SuperluSolver {
 public:
  static constexpr Triangle kTriangle = Triangle::full;
  /// SuperLU's minimum degree ordering on T + T^T, postordered.
  [[nodiscard]] static std::vector<int> elimination_order(const SparseMatrix& pattern);

  /// Symbolic analysis, and a first factorization, which sizes the storage of L and U: the values
  /// of `tangent` are to be those of a positive definite matrix.
  explicit SuperluSolver(const SparseMatrix& tangent);
  ~SuperluSolver();
  [[nodiscard]] static std::string version();
  [[nodiscard]] bool factorize();
  void solve(Vector& x);

 private:
  struct Handle;
  std::unique_ptr<Handle> handle_;
};

}  // namespace mbs::eigen_superlu
