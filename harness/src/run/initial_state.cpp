// Sparse saddle-point systems in long double: set-up work, done once a scene.
#include "run/initial_state.hpp"

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "model_math/kinematics.hpp"

namespace mbs {
namespace {

using Real = long double;
using Vector = Eigen::Matrix<Real, Eigen::Dynamic, 1>;
using Sparse = Eigen::SparseMatrix<Real>;
using Factors = Eigen::SimplicialLDLT<Sparse, Eigen::Lower>;

/// Those of `matrix`. The order of elimination, which takes longest to find where it is small, is
/// that of the matrix before if it has the same pattern, as in lanes of a sweep.
std::shared_ptr<const Factors> factors_of(const Sparse& matrix) {
  constexpr Eigen::Index kMostKept = 10'000;  // entries
  thread_local std::shared_ptr<Factors> last;
  thread_local std::vector<int> last_pattern;
  std::vector<int> pattern(matrix.outerIndexPtr(), matrix.outerIndexPtr() + matrix.cols() + 1);
  pattern.insert(pattern.end(), matrix.innerIndexPtr(), matrix.innerIndexPtr() + matrix.nonZeros());
  auto factors = last;
  last.reset();
  if (!factors || factors.use_count() > 1 || pattern != last_pattern) {
    factors = std::make_shared<Factors>();
    factors->analyzePattern(matrix);
  }
  factors->factorize(matrix);
  if (matrix.nonZeros() <= kMostKept) {
    last = factors;
    last_pattern = std::move(pattern);
  }
  return factors;
}

/// [M, J^T; J, -eps]: quasi-definite, so LDL^T without pivoting exists whatever the rank of J.
class SaddlePoint {
 public:
  SaddlePoint(const Model& model, double t, std::span<const double> q)
      : n_(model.variables()), m_(model.constraints()) {
    std::vector<Eigen::Triplet<Real>> entries;
    for (const MassEntry& entry : model.mass()) {
      if (entry.value != 0.0) entries.emplace_back(entry.row, entry.col, entry.value);
    }
    Real largest = 0;
    for (const JacobianEntry& entry : jacobian(model, t, q)) {
      entries.emplace_back(n_ + entry.row, entry.col, entry.value);
      largest = std::max(largest, std::abs(static_cast<Real>(entry.value)));
    }
    Real heaviest = 0;
    for (const MassEntry& entry : model.mass()) {
      heaviest = std::max(heaviest, static_cast<Real>(entry.value));
    }
    epsilon_ = largest > 0 ? 1e-9L * largest * largest / heaviest : 1e-9L;
    for (int k = 0; k < m_; ++k) entries.emplace_back(n_ + k, n_ + k, -epsilon_);
    Sparse matrix(n_ + m_, n_ + m_);
    matrix.setFromTriplets(entries.begin(), entries.end());
    factors_ = factors_of(matrix);
  }

  [[nodiscard]] Vector solve(const Vector& right) const { return factors_->solve(right); }
  [[nodiscard]] Real epsilon() const { return epsilon_; }

 private:
  int n_, m_;
  Real epsilon_ = 0;
  std::shared_ptr<const Factors> factors_;
};

}  // namespace

State consistent_state(const Model& model, std::span<const double> q, std::span<const double> v,
                       double t, std::span<const double> lambda) {
  const int n = model.variables();
  const int m = model.constraints();
  const SaddlePoint saddle_point(model, t, q);
  std::vector<double> curvature(static_cast<std::size_t>(m));
  constraint_curvature(model, t, q, v, curvature);
  std::vector<double> force(static_cast<std::size_t>(n));
  applied_force(model, t, q, v, force);

  Vector right = Vector::Zero(n + m);
  for (int i = 0; i < n; ++i) right[i] = force[static_cast<std::size_t>(i)];
  Vector solution = Vector::Zero(n + m);
  for (std::size_t k = 0; k < lambda.size(); ++k) {
    solution[n + static_cast<int>(k)] = lambda[k];
  }
  // Each round removes the error of -eps: lambda_k+1 from Phi_q a - eps (lambda_k+1 - lambda_k).
  // The change of lambda is eps (S + eps)^-1 times the one before, S = Phi_q M^-1 Phi_q^T, so it is
  // shorter each time: where it is not, what is left is rounding, which goes on for ever.
  constexpr int kMaxRounds = 100;
  Real change = std::numeric_limits<Real>::infinity();
  for (int round = 0; round < kMaxRounds; ++round) {
    for (int k = 0; k < m; ++k) {
      right[n + k] = -static_cast<Real>(curvature[static_cast<std::size_t>(k)]) -
                     saddle_point.epsilon() * solution[n + k];
    }
    const Vector next = saddle_point.solve(right);
    const Vector step = next - solution;
    const Real before = std::exchange(change, step.tail(m).norm());
    solution = next;
    if (!(change < before && step.norm() > 1e-17L * solution.norm())) break;
  }
  State state{{q.begin(), q.end()}, {v.begin(), v.end()}, {}, {}, t};
  for (int i = 0; i < n; ++i) state.a.push_back(static_cast<double>(solution[i]));
  for (int k = 0; k < m; ++k) state.lambda.push_back(static_cast<double>(solution[n + k]));
  return state;
}

State initial_state(const Model& model) {
  return consistent_state(model, model.initial_position(), model.initial_velocity());
}

double smallest_constraint_eigenvalue(const Model& model, std::span<const double> q) {
  const int n = model.variables();
  const int m = model.constraints();
  if (m == 0) return std::numeric_limits<double>::infinity();
  const SaddlePoint saddle_point(model, 0.0, q);
  const Real epsilon = saddle_point.epsilon();
  const auto solve = [&](const Vector& y) {  // (S + eps)^-1 y, S = Phi_q M^-1 Phi_q^T
    Vector right = Vector::Zero(n + m);
    right.tail(m) = y;
    return Vector(-saddle_point.solve(right).tail(m));
  };
  // Inverse iteration. In range(S), that is without the null vectors of dependent rows, it goes on
  // with S (S + eps)^-1 of what it found, which takes away what rounding brings in of them.
  const auto smallest = [&](bool in_range) {
    Vector y(m);
    for (int k = 0; k < m; ++k) y[k] = 1.0L + 0.5L * std::sin(1.0L + k);
    Real inverse = 0;
    constexpr int kRounds = 30;
    // Ended before, where it stands still: so strictly that a second vector cannot pass for the
    // first (the quotient shows only the square of what is in it of the other).
    constexpr Real kStill = 1e-17L;
    for (int round = 0; round < kRounds; ++round) {
      if (in_range) y -= epsilon * solve(y);
      y.normalize();
      const Vector next = solve(y);
      const Real before = std::exchange(inverse, next.dot(y));
      y = next;
      if (std::abs(inverse - before) <= kStill * inverse) break;
    }
    return std::max(1 / inverse - epsilon, Real{0});
  };
  constexpr Real kNone = 1e-6L;  // of eps: at that, 1e-15 of the largest, rows depend on each other
  const Real result = smallest(false);
  return static_cast<double>(result > kNone * epsilon ? result : smallest(true));
}

}  // namespace mbs
