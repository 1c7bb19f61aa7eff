// Dense matrices of a model through Eigen: the plain way to what the harness computes cleverly.
#pragma once

#include <Eigen/Dense>
#include <span>

#include "mbs/model.hpp"
#include "mbs/simulation.hpp"
#include "model_math/kinematics.hpp"

namespace mbs::test {

inline Eigen::MatrixXd dense_mass(const Model& model) {
  Eigen::MatrixXd M = Eigen::MatrixXd::Zero(model.variables(), model.variables());
  for (const MassEntry& entry : model.mass()) {
    M(entry.row, entry.col) = M(entry.col, entry.row) = entry.value;
  }
  return M;
}

inline Eigen::MatrixXd dense_jacobian(const Model& model, std::span<const double> q) {
  Eigen::MatrixXd Phi_q = Eigen::MatrixXd::Zero(model.constraints(), model.variables());
  for (const JacobianEntry& entry : jacobian(model, 0.0, q)) {
    Phi_q(entry.row, entry.col) += entry.value;
  }
  return Phi_q;
}

/// T of Eq. (5).
inline Eigen::MatrixXd dense_tangent(const Model& model, std::span<const double> q,
                                     const StepSettings& settings) {
  const Eigen::MatrixXd Phi_q = dense_jacobian(model, q);
  return dense_mass(model) +
         settings.step * settings.step / 4 * settings.penalty * Phi_q.transpose() * Phi_q;
}

}  // namespace mbs::test
