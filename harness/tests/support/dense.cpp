// Eigen's decompositions, compiled once for all tests.
#include "support/dense.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "model_math/kinematics.hpp"

namespace mbs::test {

Eigen::MatrixXd dense_mass(const Model& model) {
  Eigen::MatrixXd M = Eigen::MatrixXd::Zero(model.variables(), model.variables());
  for (const MassEntry& entry : model.mass()) {
    M(entry.row, entry.col) = M(entry.col, entry.row) = entry.value;
  }
  return M;
}

Eigen::MatrixXd dense_jacobian(const Model& model, std::span<const double> q) {
  Eigen::MatrixXd Phi_q = Eigen::MatrixXd::Zero(model.constraints(), model.variables());
  for (const JacobianEntry& entry : jacobian(model, 0.0, q)) {
    Phi_q(entry.row, entry.col) += entry.value;
  }
  return Phi_q;
}

Eigen::MatrixXd dense_tangent(const Model& model, std::span<const double> q, const StepSettings& settings) {
  const Eigen::MatrixXd Phi_q = dense_jacobian(model, q);
  return dense_mass(model) + settings.step * settings.step / 4 * settings.penalty * Phi_q.transpose() * Phi_q;
}

Eigen::MatrixXd dense_constraint_matrix(const Model& model, std::span<const double> q) {
  const Eigen::MatrixXd Phi_q = dense_jacobian(model, q);
  return Phi_q * dense_mass(model).llt().solve(Eigen::MatrixXd(Phi_q.transpose()));
}

Eigen::VectorXd eigenvalues(const Eigen::MatrixXd& matrix) {
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(matrix, Eigen::EigenvaluesOnly).eigenvalues();
}

}  // namespace mbs::test
