// Dense matrices of a model through Eigen: the plain way to what the harness computes cleverly. Defined in a file of
// their own, because Eigen's decompositions take many seconds to compile.
#pragma once

#include <Eigen/Core>
#include <span>

#include "mbs/model.hpp"
#include "mbs/simulation.hpp"

namespace mbs::test {

Eigen::MatrixXd dense_mass(const Model& model);

Eigen::MatrixXd dense_jacobian(const Model& model, std::span<const double> q);

/// T of Eq. (5).
Eigen::MatrixXd dense_tangent(const Model& model, std::span<const double> q, const StepSettings& settings);

/// Phi_q M^-1 Phi_q^T.
Eigen::MatrixXd dense_constraint_matrix(const Model& model, std::span<const double> q);

/// Of a symmetric matrix, the smallest first.
Eigen::VectorXd eigenvalues(const Eigen::MatrixXd& matrix);

}  // namespace mbs::test
