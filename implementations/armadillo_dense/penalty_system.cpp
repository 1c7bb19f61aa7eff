// The linear system of the penalty form: T, its factor and the right-hand sides.
#include "penalty_system.hpp"

#include "blas.hpp"

namespace mbs::armadillo_dense {

PenaltySystem::PenaltySystem(const Model& model, const StepSettings& settings,
                             CholeskySolver::Solves solves)
    : Assembly(model, settings),
      alpha_(settings.penalty),
      solver_(model.variables(), solves),
      mu_(m_, arma::fill::zeros),
      rhs_(n_, arma::fill::zeros) {
  if (!model.linear_constraints().empty()) add_linear_constraints(model);
}

void PenaltySystem::add_linear_constraints(const Model& model) {
  constant_ = M_;
  for (const LinearConstraint& constraint : model.linear_constraints()) {
    for (const LinearConstraint::Term& right : constraint.terms) {
      for (const LinearConstraint::Term& left : constraint.terms) {
        if (left.coordinate < right.coordinate) continue;
        constant_(left.coordinate, right.coordinate) +=
            h_ * alpha_ * left.coefficient * right.coefficient;
      }
    }
  }
}

void PenaltySystem::residual(const arma::vec& x, const arma::vec& v, const arma::vec& a,
                             const arma::vec& lambda) {
  mu_ = lambda + alpha_ * constraints_.phi();
  negative_residual(x, v, a, mu_, rhs_);
}

void PenaltySystem::assemble() {
  arma::mat& T = solver_.matrix();
  T = constant_.is_empty() ? M_ : constant_;  // Eq. (5)
  add_outer_product(h_ * alpha_, constraints_.jacobian(), layout_.moving, constraints_.quadratics(),
                    T);
  if (forces_.stiffen()) forces_.add_to(T.memptr(), T.n_rows);
}

void PenaltySystem::velocity_projection(const arma::vec& v) {
  rates(v, mu_);  // Eq. (6)
  penalty_product();
}

void PenaltySystem::acceleration_projection(const arma::vec& v, const arma::vec& a) {
  accelerations(v, a, mu_);  // Eq. (6)
  penalty_product();
}

void PenaltySystem::penalty_product() {
  rhs_.zeros();
  add_product(-h_ * alpha_, constraints_.jacobian(), layout_.moving, n_, m_, mu_.memptr(),
              rhs_.memptr());
}

}  // namespace mbs::armadillo_dense
