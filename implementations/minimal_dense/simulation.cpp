// The paper's step in plain loops; equations are those of paper/README.md. Start at do_step().
#include "simulation.hpp"

#include <cmath>

namespace mbs::minimal_dense {

LoopsSimulation::LoopsSimulation(const Model& model, const StepSettings& settings)
    : Simulation(model, settings), model_(model), settings_(settings) {
  for (const MassEntry& entry : model.mass()) {  // the model lists the lower half only
    M_[entry.row * n_ + entry.col] = M_[entry.col * n_ + entry.row] = entry.value;
  }
}

// "The step" of paper/README.md. phases_.enter() tells the harness what the time is spent on.
StepOutcome LoopsSimulation::do_step() {
  StepOutcome outcome{StepStatus::pass_limit};  // unless a pass converges
  predict();
  evaluate_constraints();
  while (outcome.status == StepStatus::pass_limit && outcome.passes < settings_.max_passes) {
    ++outcome.passes;
    evaluate_residual();
    assemble_tangent();
    if (!factorize_tangent()) return {StepStatus::factorization_failed, outcome.passes};
    solve(Delta_q_);  // Eq. (4)
    if (correct()) outcome.status = StepStatus::converged;
    const bool is_last =  // one that stops at the pass limit is projected like any other
        outcome.status == StepStatus::converged || outcome.passes == settings_.max_passes;
    if (is_last && settings_.projections != Projections::none) project();
    evaluate_constraints();  // at the new q': for lambda and the next pass
    phases_.enter(Phase::other);
    for (long k = 0; k < m_; ++k) lambda_[k] += alpha_ * Phi_[k];  // Eq. (1), converged or not
  }
  return outcome;
}

// Not part of a step: what its first pass computes, part by part, for `mbs check --ladder`.
bool LoopsSimulation::do_show_first_pass(FirstPass& pass) {
  predict();
  evaluate_constraints();
  evaluate_residual();
  assemble_tangent();
  pass = {q_, v_, a_, Phi_, Phi_q_, Delta_q_, T_};
  for (double& minus_f : pass.f) minus_f = -minus_f;
  return true;
}

// Eq. (2), applied to q' - q: with q' itself it cancels digits when coordinates are large.
void LoopsSimulation::predict() {
  phases_.enter(Phase::other);
  for (long i = 0; i < n_; ++i) {
    const double difference = dt_ * v_[i] + dt_ * dt_ / 2 * a_[i];
    q_[i] += difference;
    a_[i] = 4 / (dt_ * dt_) * difference - 4 / dt_ * v_[i] - a_[i];
    v_[i] = 2 / dt_ * difference - v_[i];
  }
}

// Phi and Phi_q by Eq. (7) for a distance: u = w = r_a - r_b. A fixed point is a constant and has
// no entries in q; all entries of Phi_q that are not written here stay zero.
void LoopsSimulation::evaluate_constraints() {
  phases_.enter(Phase::evaluation);
  for (long k = 0; k < m_; ++k) {
    const DotConstraint& distance = model_.dot_constraints()[k];
    const Point& a = model_.points()[distance.a];
    const Point& b = model_.points()[distance.b];
    double u_u = 0.0;
    for (int axis = 0; axis < 2; ++axis) {
      const double r_a = a.is_fixed() ? a.position[axis] : q_[a.offset + axis];
      const double r_b = b.is_fixed() ? b.position[axis] : q_[b.offset + axis];
      const double u = r_a - r_b;
      u_u += u * u;
      if (!a.is_fixed()) Phi_q_[k * n_ + a.offset + axis] = 2 * u;
      if (!b.is_fixed()) Phi_q_[k * n_ + b.offset + axis] = -2 * u;
    }
    Phi_[k] = u_u - distance.value;
  }
}

// Eq. (3), shorter by Eq. (2): f = (dt^2/4) (M a' + Phi_q^T (lambda + alpha Phi) - Q).
void LoopsSimulation::evaluate_residual() {
  phases_.enter(Phase::evaluation);
  for (long i = 0; i < n_; ++i) {
    double sum = -Q_[i];
    for (long j = 0; j < n_; ++j) sum += M_[i * n_ + j] * a_[j];
    for (long k = 0; k < m_; ++k) sum += Phi_q_[k * n_ + i] * (lambda_[k] + alpha_ * Phi_[k]);
    Delta_q_[i] = -dt_ * dt_ / 4 * sum;
  }
}

// Eq. (5) with C = K = 0: T = M + (dt^2/4) alpha Phi_q^T Phi_q. As T is symmetric, half is enough.
void LoopsSimulation::assemble_tangent() {
  phases_.enter(Phase::assembly);
  for (long i = 0; i < n_; ++i) {
    for (long j = 0; j <= i; ++j) {
      double sum = 0.0;
      for (long k = 0; k < m_; ++k) sum += Phi_q_[k * n_ + i] * Phi_q_[k * n_ + j];
      T_[i * n_ + j] = M_[i * n_ + j] + dt_ * dt_ / 4 * alpha_ * sum;
    }
  }
}

// Cholesky, T = L L^T, row by row; false if T is not positive definite.
bool LoopsSimulation::factorize_tangent() {
  phases_.enter(Phase::factorization);
  for (long i = 0; i < n_; ++i) {
    for (long j = 0; j <= i; ++j) {
      double rest = T_[i * n_ + j];
      for (long k = 0; k < j; ++k) rest -= L_[i * n_ + k] * L_[j * n_ + k];
      if (i == j && !(rest > 0.0)) return false;  // said like this, NaN fails too
      L_[i * n_ + j] = i == j ? std::sqrt(rest) : rest / L_[j * n_ + j];
    }
  }
  return true;
}

// T x = b by L y = b, then L^T x = y; x is b when it arrives.
void LoopsSimulation::solve(Vector& x) {
  phases_.enter(Phase::solve);
  for (long i = 0; i < n_; ++i) {
    for (long j = 0; j < i; ++j) x[i] -= L_[i * n_ + j] * x[j];
    x[i] /= L_[i * n_ + i];
  }
  for (long i = n_ - 1; i >= 0; --i) {
    for (long j = i + 1; j < n_; ++j) x[i] -= L_[j * n_ + i] * x[j];
    x[i] /= L_[i * n_ + i];
  }
}

// Adds Delta q; v' and a' follow by Eq. (2). True if Newton has converged, which NaN has not.
bool LoopsSimulation::correct() {
  phases_.enter(Phase::other);
  bool converged = true;
  for (long i = 0; i < n_; ++i) {
    q_[i] += Delta_q_[i];
    v_[i] += 2 / dt_ * Delta_q_[i];
    a_[i] += 4 / (dt_ * dt_) * Delta_q_[i];
    if (!(std::abs(Delta_q_[i]) <= settings_.tolerance)) converged = false;
  }
  return converged;
}

// Eq. (6), with the last pass's L and Phi_q, solved for what it changes.
void LoopsSimulation::project() {
  rate_.assign(m_, 0.0);  // Phi_t: nothing is driven
  project(v_);
  if (settings_.projections == Projections::velocity) return;

  for (long k = 0; k < m_; ++k) {  // Phi_dot_q v' by Eq. (7), with the v' just projected
    const Point& a = model_.points()[model_.dot_constraints()[k].a];
    const Point& b = model_.points()[model_.dot_constraints()[k].b];
    rate_[k] = 0.0;
    for (int axis = 0; axis < 2; ++axis) {
      const double v_a = a.is_fixed() ? 0.0 : v_[a.offset + axis];
      const double v_b = b.is_fixed() ? 0.0 : v_[b.offset + axis];
      rate_[k] += 2 * (v_a - v_b) * (v_a - v_b);
    }
  }
  project(a_);
}

// T change = -(dt^2/4) alpha Phi_q^T (Phi_q x + rate), x += change; x is v* or a*.
void LoopsSimulation::project(Vector& x) {
  phases_.enter(Phase::projection);
  for (long k = 0; k < m_; ++k) {
    for (long j = 0; j < n_; ++j) rate_[k] += Phi_q_[k * n_ + j] * x[j];
  }
  for (long i = 0; i < n_; ++i) {
    double sum = 0.0;
    for (long k = 0; k < m_; ++k) sum += Phi_q_[k * n_ + i] * rate_[k];
    change_[i] = -dt_ * dt_ / 4 * alpha_ * sum;
  }
  solve(change_);
  phases_.enter(Phase::projection);
  for (long i = 0; i < n_; ++i) x[i] += change_[i];
}

}  // namespace mbs::minimal_dense
