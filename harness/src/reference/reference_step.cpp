// The trapezoidal rule of the reference, in penalty and in saddle-point form.
#include <algorithm>
#include <cmath>
#include <utility>

#include "reference/reference_simulation.hpp"

namespace mbs {
namespace {

using Real = ReferenceSimulation::Real;

/// max |x|; NaN if x holds one.
Real largest(const ReferenceSimulation::Vector& x) {
  Real result = 0;
  for (const Real value : x) {
    if (!(std::abs(value) <= result)) result = std::abs(value);
    if (std::isnan(result)) break;
  }
  return result;
}

ReferenceSimulation::Vector negative(ReferenceSimulation::Vector x) {
  for (Real& value : x) value = -value;
  return x;
}

}  // namespace

/// Predictor, and Eq. (2) on the difference.
void ReferenceSimulation::predict() {
  const Real h = settings_.step;
  for (int i = 0; i < n_; ++i) {
    const Real difference = h * v_[i] + h * h / 2 * a_[i];
    const Real v = v_[i];
    q_[i] += difference;
    v_[i] = 2 / h * difference - v;
    a_[i] = 4 / (h * h) * difference - 4 / h * v - a_[i];
  }
}

ReferenceSimulation::Vector ReferenceSimulation::residual(const std::vector<Row>& rows) const {
  const Real h = settings_.step;
  const Vector inertia = mass_times(a_), applied = applied_force();
  Vector f = transpose_times(rows, lambda_);
  for (int i = 0; i < n_; ++i) f[i] = h * h / 4 * (inertia[i] + f[i] - applied[i]);
  return f;
}

bool ReferenceSimulation::do_show_first_pass(FirstPass& pass) {
  if (is_saddle()) return false;
  known_.set_time(time());
  predict();
  const auto rounded = [](const Vector& x) { return std::vector<double>(x.begin(), x.end()); };
  pass.q = rounded(q_), pass.v = rounded(v_), pass.a = rounded(a_);
  const Real scale = Real{settings_.step} * settings_.step / 4 * settings_.penalty;
  const Vector phi = constraints();
  const std::vector<Row> rows = jacobian();
  pass.Phi = rounded(phi);
  Vector f = residual(rows);
  const Vector penalty = transpose_times(rows, phi);
  for (int i = 0; i < n_; ++i) f[i] += scale * penalty[i];  // Eq. (3)
  pass.f = rounded(f);
  const auto n = static_cast<std::size_t>(n_);
  pass.Phi_q.assign(static_cast<std::size_t>(m_) * n, 0.0);
  for (int k = 0; k < m_; ++k) {
    for (const Entry& entry : rows[k]) {
      pass.Phi_q[k * n + entry.coordinate] += static_cast<double>(entry.value);
    }
  }
  assemble(rows);
  pass.T.resize(n * n);
  for (int i = 0; i < n_; ++i) {
    for (int j = 0; j <= i; ++j) {
      const auto [low, high] = std::minmax(place_[i], place_[j]);
      pass.T[i * n + j] = pass.T[j * n + i] = static_cast<double>(matrix_.value(high, low));
    }
  }
  return true;
}

StepOutcome ReferenceSimulation::trapezoidal_step() {
  const Real h = settings_.step;
  const Real alpha = settings_.penalty;
  StepOutcome outcome{StepStatus::pass_limit, 0, 0};
  predict();
  Real last = 0;         // max |Delta q| of the pass before
  bool updated = false;  // lambda was, after the pass before, as Newton had converged
  Pass pass;             // the last one
  while (outcome.passes < settings_.max_passes && outcome.status != StepStatus::converged) {
    ++outcome.passes;
    const Vector phi = constraints();
    pass = {q_, jacobian()};
    const std::vector<Row>& rows = pass.rows;
    const bool wanted = settings_.tangent == TangentReuse::none ||
                        (settings_.tangent == TangentReuse::step && outcome.passes == 1) ||
                        (settings_.tangent == TangentReuse::kept && due_);
    if (wanted) {
      ++outcome.factorizations;
      if (!factorize(rows)) {
        outcome.status = StepStatus::factorization_failed;
        return outcome;
      }
      due_ = false;
    }
    const Solution delta = solve(rows, negative(residual(rows)), negative(phi));  // Eqs. (4), (12)
    for (int i = 0; i < n_; ++i) {
      q_[i] += delta.x[i];
      v_[i] += 2 / h * delta.x[i];        // Eq. (2)
      a_[i] += 4 / (h * h) * delta.x[i];  // Eq. (2)
    }
    const Real change = largest(delta.x);
    const bool small = change <= settings_.tolerance;
    if (is_saddle()) {
      for (int k = 0; k < m_; ++k) lambda_[k] += 4 / (h * h) * delta.y[k];
    } else if (settings_.multipliers == MultiplierUpdate::every_pass || small) {
      const Vector phi_after = constraints();
      for (int k = 0; k < m_; ++k) lambda_[k] += alpha * phi_after[k];  // Eq. (1)
    }
    if (outcome.passes >= 2 && !small && !(change <= last / 4)) due_ = true;
    last = change;
    if (small && (updated || settings_.multipliers == MultiplierUpdate::every_pass)) {
      outcome.status = StepStatus::converged;
    }
    updated = small;
  }
  if (!project(pass, outcome.factorizations)) outcome.status = StepStatus::factorization_failed;
  if (outcome.status == StepStatus::pass_limit) due_ = true;
  return outcome;
}

bool ReferenceSimulation::project(const Pass& last, int& factorizations) {
  if (settings_.projections == Projections::none) return true;
  if (steps_ % settings_.projections_every != 0) return true;
  const Real h = settings_.step, tolerance = settings_.tolerance;
  const bool both = settings_.projections == Projections::both;
  if (settings_.tangent != TangentReuse::none || settings_.precision == Precision::mixed ||
      refines_once()) {
    const std::vector<Row> rows = jacobian();
    if (!refine(rows, v_, partial_rate(), 2 / h * tolerance, factorizations)) return false;
    return !both || refine(rows, a_, curvature(), 4 / (h * h) * tolerance, factorizations);
  }
  const auto take_away = [&](Vector& x, Vector rate) {  // Eqs. (6), (13), solved for what changes
    const Vector along = times(last.rows, x);
    for (int k = 0; k < m_; ++k) rate[k] = -(along[k] + rate[k]);
    const Vector change = solve(last.rows, Vector(n_, Real{0}), rate).x;
    for (int i = 0; i < n_; ++i) x[i] += change[i];
  };
  const Vector final_q = std::exchange(q_, last.q);
  take_away(v_, partial_rate());
  if (both) take_away(a_, curvature());
  q_ = final_q;
  return true;
}

/// Eq. (15) once, in single precision's penalty form.
bool ReferenceSimulation::refines_once() const {
  return settings_.precision == Precision::single_precision && !is_saddle() &&
         settings_.tangent == TangentReuse::none;
}

bool ReferenceSimulation::refine(const std::vector<Row>& rows, Vector& x, const Vector& rate,
                                 Real small, int& factorizations) {
  const int most = refines_once() ? 1 : 5;
  const Real eps = 4 / (Real{settings_.penalty} * settings_.step * settings_.step);
  const Vector start = x;
  Vector y(m_, Real{0});
  Real last = 0;
  for (int round = 1; round <= most; ++round) {
    Vector top(n_);  // the residual of Eqs. (6), (13)
    for (int i = 0; i < n_; ++i) top[i] = start[i] - x[i];
    top = weighted_mass_times(top);
    Vector bottom = times(rows, x);
    const Vector along = transpose_times(rows, y);
    for (int i = 0; i < n_; ++i) top[i] -= along[i];
    for (int k = 0; k < m_; ++k) bottom[k] = eps * y[k] - (bottom[k] + rate[k]);
    Solution delta = solve(rows, top, bottom);  // Eq. (15)
    if (round >= 2 && !(largest(delta.x) <= last / 2)) {
      if (settings_.tangent != TangentReuse::kept) return true;
      ++factorizations;
      if (!factorize(rows)) return false;
      delta = solve(rows, top, bottom);
    }
    for (int i = 0; i < n_; ++i) x[i] += delta.x[i];
    for (int k = 0; is_saddle() && k < m_; ++k) y[k] += delta.y[k];
    last = largest(delta.x);
    if (last <= small) return true;
  }
  return true;
}

}  // namespace mbs
