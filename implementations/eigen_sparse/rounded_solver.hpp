// Factorization and solves in float for a matrix in double.
#pragma once

#include "solver.hpp"

namespace mbs::eigen_sparse {

/// `Solver` on the matrix rounded to float, with the interface and contract of Solver<double>.
template <template <class> class Solver>
class RoundedSolver {
 public:
  static constexpr Triangle kTriangle = Solver<float>::kTriangle;
  [[nodiscard]] static std::vector<int> elimination_order(const SparseMatrix& pattern,
                                                          Tuning tuning) {
    return Solver<float>::elimination_order(pattern, tuning);
  }
  [[nodiscard]] static std::vector<int> saddle_order(const SparseMatrix& saddle,
                                                     const Followers& followers, const Model& model,
                                                     const Coordinates& coordinates,
                                                     Tuning tuning) {
    return Solver<float>::saddle_order(saddle, followers, model, coordinates, tuning);
  }

  RoundedSolver(const SparseMatrix& matrix, Definiteness definiteness, Tuning tuning)
      : matrix_(matrix),
        rounded_(matrix.cast<float>()),
        solver_(rounded_, definiteness, tuning),
        x_(matrix.cols()) {}

  [[nodiscard]] bool factorize() {
    const auto count = matrix_.nonZeros();
    Eigen::Map<Eigen::VectorXf>(rounded_.valuePtr(), count) =
        Eigen::Map<const Vector>(matrix_.valuePtr(), count).cast<float>();
    return solver_.factorize();
  }

  /// Scales x by its largest entry, so that neither it nor the solution leaves the range of float.
  void solve(Vector& x) {
    const double largest = x.cwiseAbs().maxCoeff<Eigen::PropagateNaN>();
    if (largest == 0.0) return;
    x_ = (x / largest).cast<float>();
    solver_.solve(x_);
    x = largest * x_.cast<double>();
  }

 private:
  const SparseMatrix& matrix_;
  Eigen::SparseMatrix<float> rounded_;
  Solver<float> solver_;
  Eigen::VectorXf x_;
};

}  // namespace mbs::eigen_sparse
