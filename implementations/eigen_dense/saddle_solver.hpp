// Dense factorization of the saddle-point matrix of Eq. (12) by two Cholesky factorizations.
#pragma once

#include <Eigen/Core>

#include "solver.hpp"

namespace mbs::eigen_dense {

/// Solves [T₀, B; Bᵀ, −ε] x = y, with B = Φqᵀ (n×m), by blocks:
///
///     T₀ = L Lᵀ,    X = L⁻¹ B,    S = ε + Xᵀ X = L_S L_Sᵀ
///
/// which is its L D Lᵀ factorization in the order given, D being 1 and −1. As long as T₀ stays the
/// same, its factor does.
template <typename Scalar>
class SaddleSolver {
 public:
  using Vector = Eigen::VectorX<Scalar>;
  using Matrix = Eigen::MatrixX<Scalar>;

  SaddleSolver(Eigen::Index variables, Eigen::Index constraints, Scalar epsilon);

  /// Where to write T₀ (n×n, kg; lower triangle read) before factorize_leading().
  Matrix& leading() { return leading_.matrix(); }
  /// Where to write B (n×m) before every factorize(), which overwrites it with X.
  Matrix& coupling() { return coupling_; }

  /// False if T₀ is not numerically positive definite; so is then every factorize().
  bool factorize_leading() { return has_leading_ = leading_.factorize(); }

  /// False if a block is not numerically positive definite; solve() is then meaningless.
  [[nodiscard]] bool factorize();

  /// x (n + m) holds the right-hand side on entry and the solution on return.
  void solve(Vector& x) const;

 private:
  void form_schur();

  Scalar epsilon_;
  bool has_leading_ = false;
  Solver<Scalar> leading_;  ///< L
  Matrix coupling_;         ///< B, then X
  Solver<Scalar> schur_;    ///< L_S
};

}  // namespace mbs::eigen_dense
