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
  own,  ///< what was fastest here, see README.md
  amd,  ///< in AMD's order as it is
  // Of SuperLU alone: always in the order of ...
  mmd,     ///< its minimum degree on T + T^T
  model,   ///< the model
  colamd,  ///< COLAMD, its default
  metis,   ///< METIS
  trees,   ///< SimplicialSolver, by the lowest trees
  panels,  ///< panels and relaxed supernodes as large as its sp_ienv says
};

/// L D L^T by Eigen::SimplicialLDLT in float or double. The unknowns already are in elimination
/// order, so Eigen is told to keep it and reads the upper triangle in place; the derived class
/// reaches the part of factorize() behind Eigen's permutation and copies.
template <class Scalar>
class SimplicialSolver {
 public:
  using Values = Eigen::SparseMatrix<Scalar>;
  using Side = Eigen::Matrix<Scalar, Eigen::Dynamic, 1>;
  static constexpr Triangle kTriangle = Triangle::upper;
  /// AMD's fill, eliminated by rounds unless tuned otherwise: position[i] is where unknown i of
  /// `pattern` (n x n, both triangles) is eliminated.
  [[nodiscard]] static std::vector<int> elimination_order(const SparseMatrix& pattern,
                                                          Tuning tuning);
  /// The same for `saddle`, unknowns in the order of `coordinates` and behind them multipliers,
  /// where followers follow.
  [[nodiscard]] static std::vector<int> saddle_order(const SparseMatrix& saddle,
                                                     const Followers& followers, const Model& model,
                                                     const Coordinates& coordinates, Tuning tuning);

  /// Symbolic analysis. `matrix` outlives the solver; its values may change, its pattern not.
  SimplicialSolver(const Values& matrix, Definiteness definiteness, Tuning tuning);
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

/// L U by SuperLU with diagonal pivots; the same contract as SimplicialSolver.
template <class Scalar>
class SuperluSolver {
 public:
  using Values = Eigen::SparseMatrix<Scalar>;
  using Side = Eigen::Matrix<Scalar, Eigen::Dynamic, 1>;
  static constexpr Triangle kTriangle = Triangle::full;
  /// Of several orders that in which it should be the fastest, or as tuned; postordered.
  [[nodiscard]] static std::vector<int> elimination_order(const SparseMatrix& pattern,
                                                          Tuning tuning);
  [[nodiscard]] static std::vector<int> saddle_order(const SparseMatrix& saddle,
                                                     const Followers& followers, const Model& model,
                                                     const Coordinates& coordinates, Tuning tuning);

  /// Symbolic analysis, and a first factorization, which sizes the storage of L and U: the values
  /// of `matrix` are to be those of a matrix as `definiteness` says.
  SuperluSolver(const Values& matrix, Definiteness definiteness, Tuning tuning);
  ~SuperluSolver();
  [[nodiscard]] bool factorize();
  void solve(Side& x);
  /// What the first factorization took, in operations; infinity if it failed.
  [[nodiscard]] double cost() const;

 private:
  struct Handle;
  std::unique_ptr<Handle> handle_;
};

[[nodiscard]] std::string superlu_version();

extern template class SimplicialSolver<double>;
extern template class SimplicialSolver<float>;
extern template class SuperluSolver<double>;
extern template class SuperluSolver<float>;

}  // namespace mbs::eigen_sparse
