// RATTLE and its compositions, of the reference.
#include <algorithm>
#include <cmath>

#include "reference/reference_simulation.hpp"

namespace mbs {
namespace {

using Real = ReferenceSimulation::Real;

/// Lengths of the stages of a step, in steps.
std::vector<Real> stages(Scheme scheme) {
  if (scheme == Scheme::rattle) return {1};
  if (scheme == Scheme::rattle4) {
    const Real g = 1 / (4 - std::cbrt(Real{4}));
    return {g, g, 1 - 4 * g, g, g};
  }
  const Real w1 = -1.17767998417887100694641568096431573L;
  const Real w2 = 0.235573213359358133684793182978534602L;
  const Real w3 = 0.784513610477557263819497633866349876L;
  return {w3, w2, w1, 1 - 2 * (w1 + w2 + w3), w1, w2, w3};
}

bool all_within(const ReferenceSimulation::Vector& x, Real bound) {
  return std::all_of(x.begin(), x.end(), [bound](Real value) { return std::abs(value) <= bound; });
}

constexpr int kMostRefinements = 5;

}  // namespace

StepOutcome ReferenceSimulation::rattle_step(Scheme scheme) {
  StepOutcome outcome{StepStatus::converged, 0, 0};
  for (const Real length : stages(scheme)) {
    const StageOutcome stage = rattle_stage(length * settings_.step);
    outcome.passes += stage.passes;
    ++outcome.factorizations;
    if (stage.status != StepStatus::converged) outcome.status = stage.status;
    if (stage.status == StepStatus::factorization_failed) break;
  }
  return outcome;
}

ReferenceSimulation::StageOutcome ReferenceSimulation::rattle_stage(Real h) {
  StageOutcome outcome{StepStatus::pass_limit, 0};
  const Vector before = q_, zero(n_, Real{0});
  const std::vector<Row> none(m_);
  for (int i = 0; i < n_; ++i) q_[i] += h * v_[i] + h * h / 2 * a_[i];
  while (outcome.passes < settings_.max_passes && outcome.status != StepStatus::converged) {
    ++outcome.passes;
    Vector phi = constraints();
    for (Real& value : phi) value = -value;
    const Vector delta = solve(none, zero, phi).x;
    for (int i = 0; i < n_; ++i) q_[i] += delta[i];
    if (all_within(delta, settings_.tolerance)) outcome.status = StepStatus::converged;
  }
  Vector mean(n_);  // velocity over the stage
  for (int i = 0; i < n_; ++i) mean[i] = (q_[i] - before[i]) / h;

  const std::vector<Row> rows = jacobian();
  if (!factorize(rows)) {
    outcome.status = StepStatus::factorization_failed;
    return outcome;
  }
  Vector top = mass_times(mean);
  const Vector applied = applied_force();
  for (int i = 0; i < n_; ++i) top[i] += h / 2 * applied[i];
  v_ = solve(rows, top, Vector(m_, Real{0})).x;
  rattle_velocity(rows);
  rattle_acceleration(rows);
  return outcome;
}

void ReferenceSimulation::rattle_velocity(const std::vector<Row>& rows) {
  const Vector zero(n_, Real{0});
  for (int round = 0; round < kMostRefinements; ++round) {
    Vector bottom = times(rows, v_);
    for (Real& value : bottom) value = -value;
    const Vector delta = solve(rows, zero, bottom).x;
    for (int i = 0; i < n_; ++i) v_[i] += delta[i];
    if (all_within(delta, 2 / Real{settings_.step} * settings_.tolerance)) break;
  }
}

void ReferenceSimulation::rattle_acceleration(const std::vector<Row>& rows) {
  const Real step = settings_.step;
  const Vector quadratic = curvature(), zero(n_, Real{0});
  Vector bottom(m_);
  for (int k = 0; k < m_; ++k) bottom[k] = -quadratic[k];
  const Solution start = solve(rows, applied_force(), bottom);
  a_ = start.x;
  lambda_ = start.y;
  for (int round = 0; round < kMostRefinements; ++round) {
    const Vector along = times(rows, a_);
    for (int k = 0; k < m_; ++k) bottom[k] = -(quadratic[k] + along[k]);
    const Solution delta = solve(rows, zero, bottom);
    for (int i = 0; i < n_; ++i) a_[i] += delta.x[i];
    for (int k = 0; k < m_; ++k) lambda_[k] += delta.y[k];
    if (all_within(delta.x, 4 / (step * step) * settings_.tolerance)) break;
  }
}

}  // namespace mbs
