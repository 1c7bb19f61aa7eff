// The symmetric multistep method of order six: Eq. (17).
#include "multistep.hpp"

#include <algorithm>
#include <cmath>

#include "stage_lengths.hpp"

namespace mbs::eigen_dense {

namespace {

constexpr double b0 = 3331.0 / 2400, b1 = -73.0 / 300, b2 = 3133.0 / 1200;  // Eq. (17)
constexpr double d1 = 475.0 / 288, d2 = -247.0 / 90, d3 = 631.0 / 240, d4 = -58.0 / 45,
                 d5 = 367.0 / 1440;

/// The first pass leaves violations that the recursion of the multipliers would keep.
constexpr int kLeastPasses = 2;

}  // namespace

Multistep::Multistep(const Model& model, const StepSettings& settings)
    : mbs::Simulation(model, settings),
      settings_(settings),
      factor_(b0 * settings.step * settings.step),
      lengths_(stage_lengths<double>(settings)),
      stage_(model, settings, phases_),
      w_(Eigen::MatrixXd::Zero(model.variables(), kHistory)),
      a_(w_),
      residual_(Eigen::VectorXd::Zero(model.variables())) {}

void Multistep::do_set_state(const State& state) {
  stage_.set(state);
  complete_ = true;
  started_ = 0;
}

StepOutcome Multistep::do_step() {
  StepOutcome outcome{StepStatus::converged, 0, 0};
  const bool starting = started_ < kHistory;
  if (!(starting ? start(outcome) : advance(outcome))) {
    outcome.status = StepStatus::factorization_failed;
    outcome.passes = std::max(outcome.passes, 1);
    return outcome;
  }
  if (starting) ++started_;
  complete_ = starting;
  newest_ = (newest_ + 1) % kHistory;
  return outcome;
}

bool Multistep::start(StepOutcome& outcome) {
  auto w = w_.col(newest_);
  w.setZero();
  a_.col(newest_) = stage_.motion().a;
  for (const double h : lengths_) {
    if (!stage_.advance(h, outcome)) return false;
    w += stage_.change();
  }
  return true;
}

bool Multistep::advance(StepOutcome& outcome) {
  ++outcome.factorizations;
  if (!stage_.refresh()) return false;
  predict();
  phases_.enter(Phase::evaluation);
  stage_.assembly().mass_product(a_.col(newest_), residual_);
  residual_ = factor_ * (stage_.force() - residual_);
  auto& q = stage_.motion().q;
  q.head(residual_.size()) += w_.col(newest_);
  bool converged = false;
  while (!converged && outcome.passes < settings_.max_passes) {
    phases_.enter(Phase::evaluation);
    stage_.assembly().evaluate(q);
    stage_.solve(outcome.passes == 0 ? residual_ : stage_.zero(), stage_.assembly().Phi());
    ++outcome.passes;
    converged = correct() && outcome.passes >= kLeastPasses;
  }
  if (!converged) outcome.status = StepStatus::pass_limit;
  return true;
}

void Multistep::predict() {
  const auto a1 = a_.col(column(1)), a2 = a_.col(column(2)), a3 = a_.col(column(3)),
             a4 = a_.col(column(4));
  const auto w1 = w_.col(column(1)), w2 = w_.col(column(2)), w3 = w_.col(column(3)),
             w4 = w_.col(column(4));
  auto a = a_.col(newest_), w = w_.col(newest_);
  a += 5 * (a1 - a4) - 10 * (a2 - a3);
  const double squared = settings_.step * settings_.step;
  w += 0.1 * (w1 - w4) - 0.2 * (w2 - w3) +
       squared * (b0 * (a + a4) + b1 * (a1 + a3) + b2 * a2);  // Eq. (17)
}

bool Multistep::correct() {
  const double* const delta = stage_.upper().data();
  const double per_factor = 1 / factor_;
  double* const q = stage_.motion().q.data();
  double* const w = w_.col(newest_).data();
  double* const a = a_.col(newest_).data();
  const Index n = w_.rows();
  Index beyond = 0;
  for (Index i = 0; i < n; ++i) {
    q[i] += delta[i];
    w[i] += delta[i];
    a[i] += per_factor * delta[i];
    beyond += !(std::abs(delta[i]) <= settings_.tolerance);  // so that NaN is beyond it
  }
  return beyond == 0;
}

void Multistep::do_get_state(State& state) const {
  if (!complete_) complete();
  stage_.motion().get(state);
}

// Overwrites the matrix and the evaluations of the last step; the next one begins with its own.
void Multistep::complete() const {
  const double step = settings_.step;
  stage_.motion().v.head(w_.rows()) =
      w_.col(column(1)) / step +
      step * (d1 * a_.col(column(1)) + d2 * a_.col(column(2)) + d3 * a_.col(column(3)) +
              d4 * a_.col(column(4)) + d5 * a_.col(column(5)));
  complete_ = true;
  if (!stage_.refresh()) return;
  stage_.refine_velocity();
  stage_.find_acceleration();
}

}  // namespace mbs::eigen_dense
