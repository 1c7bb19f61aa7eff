// Lets a solver of float numbers solve for double ones.
#pragma once

#include <Eigen/Core>

#include "largest.hpp"

namespace mbs::eigen_dense {

/// `FloatSolver` as it is, but for right-hand sides in double: they are divided by their largest
/// entry before they are rounded, so that neither they nor the solution underflow.
template <typename FloatSolver>
class Rounded : public FloatSolver {
 public:
  using FloatSolver::FloatSolver;

  /// x holds the right-hand side on entry and the solution on return.
  void solve(Eigen::VectorXd& x) {
    const double size = largest(x);
    if (size == 0.0) return;  // so is the solution; a NaN goes on
    rounded_ = (x / size).cast<float>();
    FloatSolver::solve(rounded_);
    x = size * rounded_.cast<double>();
  }

 private:
  Eigen::VectorXf rounded_;
};

}  // namespace mbs::eigen_dense
