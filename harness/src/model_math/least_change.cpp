// The saddle-point system [M, J^T; J, -eps] (x, y) = (0, right), in long double.
#include "model_math/least_change.hpp"

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "model_math/kinematics.hpp"

namespace mbs {
namespace {

using Real = long double;
using Vector = Eigen::Matrix<Real, Eigen::Dynamic, 1>;
using Sparse = Eigen::SparseMatrix<Real>;

/// eps as a share of a row's own (J M^-1 J^T)_kk. It makes redundant rows solvable and costs as
/// many of long double's nineteen digits; both errors are relative to x.
constexpr Real kRegularization = 1e-11L;

}  // namespace

struct LeastChange::Factors {
  int n = 0, m = 0;
  Eigen::SimplicialLDLT<Sparse, Eigen::Lower> ldlt;
};

LeastChange::LeastChange(const Model& model, double t, std::span<const double> q,
                         const std::vector<double>& weights, double damping)
    : factors_(std::make_unique<Factors>()) {
  const int n = factors_->n = model.variables();
  const int m = factors_->m = model.constraints();
  const auto weight = [&](int i) {
    return weights.empty() ? 1.0 : weights[static_cast<std::size_t>(i)];
  };
  const auto is_held = [&](int i) { return std::isinf(weight(i)); };
  const std::vector<double> diagonal = mass_diagonal(model);
  std::vector<Eigen::Triplet<Real>> entries;
  for (const MassEntry& entry : model.mass()) {
    const bool is_free = !is_held(entry.row) && !is_held(entry.col);
    if (entry.value == 0.0 || (!is_free && entry.row != entry.col)) continue;
    const double factor = is_free ? weight(entry.row) * weight(entry.col) : 1.0;
    entries.emplace_back(entry.row, entry.col, factor * entry.value);
  }
  std::vector<Real> size(static_cast<std::size_t>(m), 0);
  for (const JacobianEntry& entry : jacobian(model, t, q)) {
    if (!std::isfinite(entry.value)) throw std::invalid_argument("Phi_q is not finite");
    if (is_held(entry.col) || entry.value == 0.0) continue;
    entries.emplace_back(n + entry.row, entry.col, entry.value);
    const Real scaled = entry.value / weight(entry.col);
    size[static_cast<std::size_t>(entry.row)] +=
        scaled * scaled / diagonal[static_cast<std::size_t>(entry.col)];
  }
  const Real epsilon = std::max(kRegularization, static_cast<Real>(damping));
  for (int k = 0; k < m; ++k) {
    const Real own = size[static_cast<std::size_t>(k)];
    entries.emplace_back(n + k, n + k, own > 0 ? -epsilon * own : Real{-1});
  }
  Sparse matrix(n + m, n + m);
  matrix.setFromTriplets(entries.begin(), entries.end());
  // Quasi-definite, so that LDL^T without pivoting exists whatever the rank of J.
  factors_->ldlt.compute(matrix);
}

LeastChange::~LeastChange() = default;

std::vector<double> LeastChange::solve(std::span<const double> right) const {
  Vector full = Vector::Zero(factors_->n + factors_->m);
  for (int k = 0; k < factors_->m; ++k) full[factors_->n + k] = right[static_cast<std::size_t>(k)];
  const Vector solution = factors_->ldlt.solve(full);
  std::vector<double> x(static_cast<std::size_t>(factors_->n));
  for (int i = 0; i < factors_->n; ++i) {
    x[static_cast<std::size_t>(i)] = static_cast<double>(solution[i]);
  }
  return x;
}

}  // namespace mbs
