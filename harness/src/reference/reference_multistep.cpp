// The symmetric multistep method, of the reference.
#include <algorithm>
#include <cmath>

#include "reference/reference_simulation.hpp"

namespace mbs {
namespace {

using Real = ReferenceSimulation::Real;
using Vector = ReferenceSimulation::Vector;

constexpr std::size_t kPast = 5;
constexpr Real kW[] = {0.1L, -0.2L, 0.2L, -0.1L, 1};
constexpr Real kOuter = 3331.0L / 2400, kInner = -73.0L / 300, kMiddle = 3133.0L / 1200;
constexpr Real kA[] = {kInner, kMiddle, kInner, kOuter};  // of the past; kOuter of the present too
constexpr Real kPredicted[] = {5, -10, 10, -5, 1};
constexpr Real kVelocity[] = {475.0L / 288, -247.0L / 90, 631.0L / 240, -58.0L / 45, 367.0L / 1440};

/// Sum of the newest vectors, the first of `past`, times `weights`.
template <std::size_t size>
Vector combine(const std::deque<Vector>& past, const Real (&weights)[size]) {
  Vector sum(past.front().size());
  for (std::size_t j = 0; j < size; ++j) {
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += weights[j] * past[j][i];
  }
  return sum;
}

void remember(std::deque<Vector>& past, const Vector& newest) {
  past.push_front(newest);
  if (past.size() > kPast) past.pop_back();
}

}  // namespace

StepOutcome ReferenceSimulation::multistep() {
  const Vector before = q_;
  if (w_.size() < kPast) {
    remember(past_a_, a_);
    const StepOutcome outcome = rattle_step(Scheme::rattle6);
    Vector w = q_;
    for (int i = 0; i < n_; ++i) w[i] -= before[i];
    remember(w_, w);
    return outcome;
  }
  StepOutcome outcome{StepStatus::pass_limit, 0, 1};
  if (!factorize(jacobian())) return {StepStatus::factorization_failed, 1, 1};
  const Real square = Real{settings_.step} * settings_.step;
  Vector a = combine(past_a_, kPredicted), w = combine(w_, kW);
  const Vector kicks = combine(past_a_, kA), inertia = mass_times(a), applied = applied_force();
  Vector top(n_);
  for (int i = 0; i < n_; ++i) {
    w[i] += square * (kicks[i] + kOuter * a[i]);
    top[i] = kOuter * square * (applied[i] - inertia[i]);
    q_[i] += w[i];
  }
  while (outcome.passes < settings_.max_passes && outcome.status != StepStatus::converged) {
    ++outcome.passes;
    Vector bottom = constraints();
    for (Real& value : bottom) value = -value;
    const Vector delta = solve({}, top, bottom).x;
    const bool is_small =
        std::ranges::all_of(delta, [this](Real x) { return std::abs(x) <= settings_.tolerance; });
    for (int i = 0; i < n_; ++i) {
      q_[i] += delta[i];
      w[i] += delta[i];
      a[i] += delta[i] / (kOuter * square);
      top[i] = 0;
    }
    if (outcome.passes >= 2 && is_small) outcome.status = StepStatus::converged;
  }
  remember(w_, w);
  remember(past_a_, a);
  complete_multistep();
  return outcome;
}

void ReferenceSimulation::complete_multistep() {
  const Real step = settings_.step;
  v_ = combine(past_a_, kVelocity);
  for (int i = 0; i < n_; ++i) v_[i] = w_.front()[i] / step + step * v_[i];
  const std::vector<Row> rows = jacobian();
  if (!factorize(rows)) return;
  rattle_velocity(rows);
  rattle_acceleration(rows);
}

}  // namespace mbs
