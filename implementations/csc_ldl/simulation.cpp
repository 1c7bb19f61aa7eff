// The step; equations are those of paper/README.md. Start at do_step().
#include "simulation.hpp"

#include <algorithm>
#include <cmath>

namespace mbs::csc_ldl {
namespace {

bool has_factors_of_time(const Model& model) {
  const auto varies = [](const auto& element) { return !element.law.factor.is_constant(); };
  return std::ranges::any_of(model.force_laws(), varies) ||
         std::ranges::any_of(model.torque_laws(), varies);
}

}  // namespace

LdlSimulation::LdlSimulation(const Model& model, const StepSettings& settings, Order order)
    : Simulation(model, settings),
      model_(model),
      settings_(settings),
      numbering_(number_unknowns(model, saddle_point_, order)),
      at_(model, numbering_.state),
      mass_(model.mass(), numbering_.state),
      constraints_(model, at_),
      elements_(model, at_, dt_),
      assembly_(model, settings, numbering_, constraints_, elements_),
      row_parts_(constraints_.force_parts()),
      element_parts_(elements_.force_parts()),
      are_driven_(!model.driven_points().empty() || !model.driven_values().empty() ||
                  has_factors_of_time(model)) {
  for (int i = 0; i < n_; ++i) minus_Q_[numbering_.state[i]] = -model.force()[i];
  for (std::size_t p = 0; p < model.points().size(); ++p) {
    const Point& point = model.points()[p];
    for (int axis = 0; point.is_fixed() && axis < model.dimension(); ++axis) {
      q_[at_(static_cast<int>(p), axis)] = point.position[axis];
    }
  }
  constraints_.visit_forces([this](int, int i, int part) { row_forces_.add(i, part); });
  elements_.visit_forces([this](int i, int part) { element_forces_.add(i, part); });
  row_forces_.finish();
  element_forces_.finish();
  if (are_driven_) {
    all_v_ = all_a_ = Vector(at_.total);
    force_ = minus_Q_;
  }
}

void LdlSimulation::do_set_state(const State& state) {
  for (int i = 0; i < n_; ++i) {
    const int place = numbering_.state[i];
    q_[place] = state.q[i];
    v_[place] = state.v[i];
    a_[place] = state.a[i];
  }
  for (int k = 0; k < m_; ++k) lambda_[k] = state.lambda[constraints_.model_row()[k]];
}

void LdlSimulation::do_get_state(State& state) const {
  for (int i = 0; i < n_; ++i) {
    const int place = numbering_.state[i];
    state.q[i] = q_[place];
    state.v[i] = v_[place];
    state.a[i] = a_[place];
  }
  for (int k = 0; k < m_; ++k) state.lambda[constraints_.model_row()[k]] = lambda_[k];
}

// "The step" of paper/README.md, or its saddle-point form in other_schemes.md.
StepOutcome LdlSimulation::do_step() {
  StepOutcome outcome{StepStatus::pass_limit};  // unless a pass converges
  phases_.enter(Phase::other);
  if (are_driven_) drive();
  predict();
  evaluate_constraints();
  while (outcome.status == StepStatus::pass_limit && outcome.passes < settings_.max_passes) {
    ++outcome.passes;
    evaluate_residual();
    assemble();
    if (!factorize()) return {StepStatus::factorization_failed, outcome.passes};
    solve();  // Eq. (4) or (12)
    if (correct()) outcome.status = StepStatus::converged;
    const bool is_last =
        outcome.status == StepStatus::converged || outcome.passes == settings_.max_passes;
    if (saddle_point_) update_multipliers(bottom_, 4 / (dt_ * dt_));  // what came with Eq. (12)
    if (is_last && settings_.projections != Projections::none) project();
    if (!saddle_point_ || !is_last) evaluate_constraints();  // at the new q'
    if (!saddle_point_) update_multipliers(constraints_.Phi, alpha_);  // Eq. (1)
  }
  return outcome;
}

// Not part of a step: what its first pass computes, for `mbs check --ladder`.
bool LdlSimulation::do_show_first_pass(FirstPass& pass) {
  if (are_driven_) drive();
  predict();
  evaluate_constraints();
  evaluate_residual();
  assemble();
  State state{Vector(n_), Vector(n_), Vector(n_), Vector(m_)};
  do_get_state(state);
  pass.q = state.q;
  pass.v = state.v;
  pass.a = state.a;
  pass.Phi.resize(m_);
  pass.Phi_q.resize(static_cast<std::size_t>(m_) * n_);
  std::vector<int> coordinate(n_);  // of the model, by place in the state
  for (int i = 0; i < n_; ++i) coordinate[numbering_.state[i]] = i;
  std::ranges::fill(g_, 1.0);
  constraints_.write_forces(g_.data(), row_parts_.data());
  constraints_.visit_forces([&](int row, int i, int part) {
    const std::size_t model_row = constraints_.model_row()[row];
    pass.Phi_q[model_row * n_ + coordinate[i]] += row_parts_[part];
  });
  for (int k = 0; k < m_; ++k) pass.Phi[constraints_.model_row()[k]] = constraints_.Phi[k];
  if (saddle_point_) return true;  // f and T are those of the penalty form
  pass.f.resize(n_);
  for (int i = 0; i < n_; ++i) pass.f[i] = -top_[numbering_.state[i]];
  pass.T = assembly_.dense();
  return true;
}

// What is known of time t', for the whole step.
void LdlSimulation::drive() {
  const double t = time();
  constraints_.drive(t);
  elements_.drive(t);
  for (const DrivenPoint& driven : model_.driven_points()) {
    for (int axis = 0; axis < at_.dimension; ++axis) {
      const TimeFunction::Sample r = driven.position[axis].at(t);
      const int place = at_(driven.point, axis);
      q_[place] = r.value;
      all_v_[place] = r.rate;
      all_a_[place] = r.acceleration;
    }
  }
  minus_Q_ = force_;
  for (const DrivenMass& mass : model_.driven_mass()) {
    minus_Q_[numbering_.state[mass.coordinate]] += mass.value * all_a_[at_(mass.point, mass.axis)];
  }
}

// Eq. (2), applied to q' - q: with q' itself it cancels digits when coordinates are large.
void LdlSimulation::predict() {
  phases_.enter(Phase::other);
  double *q = q_.data(), *v = v_.data(), *a = a_.data();
  const double v_by_q = 2 / dt_, a_by_q = 4 / (dt_ * dt_), a_by_v = 4 / dt_, half = dt_ * dt_ / 2;
#pragma GCC ivdep
  for (int i = 0; i < n_; ++i) {
    const double difference = dt_ * v[i] + half * a[i];
    q[i] += difference;
    a[i] = a_by_q * difference - a_by_v * v[i] - a[i];
    v[i] = v_by_q * difference - v[i];
  }
}

// Phi and Phi_q, Eqs. (7) and (8).
void LdlSimulation::evaluate_constraints() {
  phases_.enter(Phase::evaluation);
  constraints_.evaluate(q_.data());
}

// Eq. (3), shorter by Eq. (2): -f = -(dt^2/4) (M a' + Phi_q^T g - Q) with g = lambda + alpha Phi
// or, of f_0 in Eq. (12), g = lambda.
void LdlSimulation::evaluate_residual() {
  phases_.enter(Phase::evaluation);
  const double alpha = saddle_point_ ? 0.0 : alpha_, factor = -dt_ * dt_ / 4;
  for (int k = 0; k < m_; ++k) g_[k] = lambda_[k] + alpha * constraints_.Phi[k];
  constraints_.write_forces(g_.data(), row_parts_.data());
  mass_.multiply(a_.data(), top_.data());
  row_forces_.apply(top_.data(), row_parts_.data(), top_.data());
  if (!elements_.empty()) {
    elements_.evaluate(q_.data(), of_all_points(v_, all_v_), element_parts_.data(),
                       assembly_.element_parts());
    element_forces_.apply(top_.data(), element_parts_.data(), top_.data());
  }
  for (int i = 0; i < n_; ++i) top_[i] = factor * (top_[i] + minus_Q_[i]);
  if (saddle_point_) {
    for (int k = 0; k < m_; ++k) bottom_[k] = -constraints_.Phi[k];
  }
}

void LdlSimulation::assemble() {
  phases_.enter(Phase::assembly);
  assembly_.assemble(constraints_);
}

bool LdlSimulation::factorize() {
  phases_.enter(Phase::factorization);
  return assembly_.factorize();
}

void LdlSimulation::solve() {
  phases_.enter(Phase::solve);
  assembly_.solve(top_, bottom_);
}

// Adds Delta q; v' and a' follow by Eq. (2). True if Newton has converged, which NaN has not.
bool LdlSimulation::correct() {
  phases_.enter(Phase::other);
  double *q = q_.data(), *v = v_.data(), *a = a_.data();
  const double* Delta_q = top_.data();
  const double v_by_q = 2 / dt_, a_by_q = 4 / (dt_ * dt_), tolerance = settings_.tolerance;
  int larger = 0;
#pragma GCC ivdep
  for (int i = 0; i < n_; ++i) {
    q[i] += Delta_q[i];
    v[i] += v_by_q * Delta_q[i];
    a[i] += a_by_q * Delta_q[i];
    larger += !(std::abs(Delta_q[i]) <= tolerance);
  }
  return larger == 0;
}

// Converged or not.
void LdlSimulation::update_multipliers(const Vector& change, double factor) {
  phases_.enter(Phase::other);
  for (int k = 0; k < m_; ++k) lambda_[k] += factor * change[k];
}

// v_ or a_; `all` has what driven points have of it, at their places.
const double* LdlSimulation::of_all_points(const Vector& x, Vector& all) {
  if (!are_driven_) return x.data();
  for (int i = 0; i < n_; ++i) all[i] = x[i];
  return all.data();
}

// Eq. (6) or (13), with the last pass's factors and Phi_q, solved for what it changes.
void LdlSimulation::project() {
  phases_.enter(Phase::projection);
  constraints_.rate(g_.data());
  project(v_, of_all_points(v_, all_v_));
  if (settings_.projections == Projections::velocity) return;
  constraints_.second_rate(of_all_points(v_, all_v_), g_.data());
  project(a_, of_all_points(a_, all_a_));
}

// x + what takes Phi_q x + g_ away, x being v* or a*; `all` has driven points', too.
void LdlSimulation::project(Vector& x, const double* all) {
  std::ranges::fill(top_, 0.0);
  if (saddle_point_) {
    constraints_.add_product(all, g_.data());
    for (int k = 0; k < m_; ++k) bottom_[k] = -g_[k];
  } else {
    constraints_.write_reactions(-dt_ * dt_ / 4 * alpha_, all, g_.data(), row_parts_.data());
    row_forces_.apply(top_.data(), row_parts_.data(), top_.data());
  }
  solve();
  phases_.enter(Phase::projection);
  for (int i = 0; i < n_; ++i) x[i] += top_[i];
}

}  // namespace mbs::csc_ldl
