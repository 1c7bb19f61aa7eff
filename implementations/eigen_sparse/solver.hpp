// The two factorizations behind one interface: Eigen's simplicial LDL^T and SuperLU.
#pragma once

#include <Eigen/SparseCholesky>
#include <memory>
#include <string>
#include <vector>

#include "coordinates.hpp"

namespace mbs::eigen_sparse {

/// Which part of a symmetric matrix a solver wants stored.
enum class Triangle { upper, full };

/// What is known of a symmetric matrix that is factorized without pivoting.
enum class Definiteness {
  positive,  ///< T of Eq. (5): all pivots are positive, and every entry of Phi_q shows on the
             ///< diagonal
  quasi,     ///< Eqs. (12) and (14): pivots of both signs
};

/// For each unknown those that may be eliminated only after it.
using Followers = std::vector<std::vector<int>>;

/// Settings of the solvers.
enum class Tuning {
  own,     ///< what was fastest here, see README.md
  amd,     ///< in AMD's order as it is
  colamd,  ///< SuperLU: in the order of COLAMD, its default
  panels,  ///< SuperLU: panels and relaxed supernodes as large as its sp_ienv says
};

/// L D L^T by Eigen::SimplicialLDLT in float or double. The unknowns already are in elimination
/// order, so Eigen is told to keep it and reads the upper triangle in place; the derived class
/// reaches the part of factorize() behind Eigen's permutation and copies.
template <class Scalar, Tuning kTuning>
class TunedSimplicial {
 public:
  using Values = Eigen::SparseMatrix<Scalar>;
  using Side = Eigen::Matrix<Scalar, Eigen::Dynamic, 1>;
  static constexpr Triangle kTriangle = Triangle::upper;
  /// AMD's fill, eliminated by rounds unless tuned otherwise: position[i] is where unknown i of
  /// `pattern` (n x n, both triangles) is eliminated.
  [[nodiscard]] static std::vector<int> elimination_order(const SparseMatrix& pattern);
  /// An order of the same fill as the present one, in the form that this solver wants, where
  /// followers still follow.
  [[nodiscard]] static std::vector<int> equivalent_order(const SparseMatrix& pattern,
                                                         const Followers& followers);

  /// Symbolic analysis. `matrix` outlives the solver; its values may change, its pattern not.
  TunedSimplicial(const Values& matrix, Definiteness definiteness);
  /// Factorizes the present values; false unless all pivots are positive numbers, or for a
  /// quasi-definite matrix numbers other than zero.
  [[nodiscard]] bool factorize();
  /// Overwrites x (n) by the solution, with the last successful factorization.
  void solve(Side& x) const;

 private:
  using Factors = Eigen::SimplicialLDLT<Values, Eigen::Upper, Eigen::NaturalOrdering<int>>;
  struct Preordered : Factors {
    void refactorize(const Values& matrix) { this->template factorize_preordered<true>(matrix); }
    [[nodiscard]] const Side& pivots() const { return this->m_diag; }
  };

  const Values& matrix_;
  Definiteness definiteness_;
  Preordered factors_;
};

/// L U by SuperLU with diagonal pivots; the same contract as TunedSimplicial.
template <class Scalar, Tuning kTuning>
class TunedSuperlu {
 public:
  using Values = Eigen::SparseMatrix<Scalar>;
  using Side = Eigen::Matrix<Scalar, Eigen::Dynamic, 1>;
  static constexpr Triangle kTriangle = Triangle::full;
  /// SuperLU's minimum degree ordering on T + T^T, or as tuned, postordered.
  [[nodiscard]] static std::vector<int> elimination_order(const SparseMatrix& pattern);
  [[nodiscard]] static std::vector<int> equivalent_order(const SparseMatrix& pattern,
                                                         const Followers& followers);

  /// Symbolic analysis, and a first factorization, which sizes the storage of L and U: the values
  /// of `matrix` are to be those of a matrix as `definiteness` says.
  TunedSuperlu(const Values& matrix, Definiteness definiteness);
  ~TunedSuperlu();
  [[nodiscard]] bool factorize();
  void solve(Side& x);

 private:
  struct Handle;
  std::unique_ptr<Handle> handle_;
};

[[nodiscard]] std::string superlu_version();

template <class Scalar>
using SimplicialSolver = TunedSimplicial<Scalar, Tuning::own>;
template <class Scalar>
using SuperluSolver = TunedSuperlu<Scalar, Tuning::own>;

extern template class TunedSimplicial<double, Tuning::own>;
extern template class TunedSimplicial<float, Tuning::own>;
extern template class TunedSimplicial<double, Tuning::amd>;
extern template class TunedSuperlu<double, Tuning::own>;
extern template class TunedSuperlu<float, Tuning::own>;
extern template class TunedSuperlu<double, Tuning::amd>;
extern template class TunedSuperlu<double, Tuning::colamd>;
extern template class TunedSuperlu<double, Tuning::panels>;

}  // namespace mbs::eigen_sparse
