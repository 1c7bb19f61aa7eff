// RATTLE of order two, four and six: stages of Eq. (14).
#include "rattle.hpp"

#include <cmath>

#include "largest.hpp"

namespace mbs::eigen_dense {

namespace {

constexpr int kRefinements = 5;

/// The lengths of the stages, as shares of the step.
std::vector<double> stage_shares(Scheme scheme) {
  if (scheme == Scheme::rattle4) {
    const double gamma = 1.0 / (4.0 - std::cbrt(4.0));
    return {gamma, gamma, 1.0 - 4.0 * gamma, gamma, gamma};
  }
  if (scheme == Scheme::rattle6) {
    constexpr double w1 = -1.17767998417887100694641568096431573;
    constexpr double w2 = 0.235573213359358133684793182978534602;
    constexpr double w3 = 0.784513610477557263819497633866349876;
    constexpr double w0 = 1.0 - 2.0 * (w1 + w2 + w3);
    return {w3, w2, w1, w0, w1, w2, w3};
  }
  return {1.0};
}

}  // namespace

template <typename Scalar>
Rattle<Scalar>::Rattle(const Model& model, const StepSettings& settings)
    : mbs::Simulation(model, settings),
      settings_(settings),
      layout_(model),
      assembly_(model, settings, layout_),
      solver_(model.variables(), model.constraints(),
              Scalar(4 / (settings.penalty * settings.step * settings.step))),
      motion_(model, layout_),
      zero_(Vector::Zero(model.variables())),
      start_(zero_),
      change_(zero_),
      force_(zero_),
      impulse_(zero_),
      x_(Vector::Zero(model.variables() + model.constraints())) {
  for (const double share : stage_shares(settings.scheme)) {
    stages_.push_back(Scalar(share * settings.step));
  }
  assembly_.mass(solver_.leading());
  solver_.factorize_leading();
  refresh();
  find_acceleration();
}

template <typename Scalar>
void Rattle<Scalar>::do_set_state(const State& state) {
  motion_.set(state);
  refresh();
  find_acceleration();
}

template <typename Scalar>
StepOutcome Rattle<Scalar>::do_step() {
  StepOutcome outcome{StepStatus::converged, 0, 0};
  for (const Scalar h : stages_) {
    if (!factorized_ || !stage(h, outcome)) {
      outcome.status = StepStatus::factorization_failed;
      return outcome;
    }
  }
  return outcome;
}

template <typename Scalar>
bool Rattle<Scalar>::stage(Scalar h, StepOutcome& outcome) {
  move(h, outcome);
  ++outcome.factorizations;
  refresh();
  if (!factorized_) return false;
  find_velocity(h);
  find_acceleration();
  return true;
}

// Keeps q' − q apart from q', which is rounded to the last digit of q: in float those digits would
// drive w away from the motion.
template <typename Scalar>
void Rattle<Scalar>::move(Scalar h, StepOutcome& outcome) {
  phases_.enter(Phase::other);
  const auto n = motion_.a.size();
  auto q = motion_.q.head(n);
  start_ = q;
  change_ = h * motion_.v.head(n) + h * h / 2 * motion_.a;
  q = start_ + change_;
  bool converged = false;
  for (int pass = 0; pass < settings_.max_passes && !converged; ++pass) {
    ++outcome.passes;
    phases_.enter(Phase::evaluation);
    assembly_.evaluate(motion_.q);
    solve(zero_, assembly_.Phi());  // Eq. (14) at the stage's start
    change_ += upper();
    q = start_ + change_;
    converged = largest(upper()) <= Scalar(settings_.tolerance);
  }
  if (!converged) outcome.status = StepStatus::pass_limit;
}

template <typename Scalar>
void Rattle<Scalar>::refresh() {
  phases_.enter(Phase::evaluation);
  assembly_.evaluate(motion_.q);
  assembly_.scaled_force(motion_.q, motion_.v, force_);
  force_ *= Scalar(4 / (settings_.step * settings_.step));
  phases_.enter(Phase::assembly);
  solver_.coupling() = assembly_.jacobian_transposed();  // Eq. (14)
  phases_.enter(Phase::factorization);
  factorized_ = solver_.factorize();
  phases_.enter(Phase::other);
}

// Solves for v' − w instead of v': [(h/2) Q; −Φq w] for [M w + (h/2) Q; 0] on the right.
template <typename Scalar>
void Rattle<Scalar>::find_velocity(Scalar h) {
  const Scalar bound = Scalar(2 / settings_.step * settings_.tolerance);
  auto v = motion_.v.head(motion_.a.size());
  phases_.enter(Phase::projection);
  v = change_ / h;
  impulse_ = h / 2 * force_;
  solve(impulse_, assembly_.velocity_error(motion_.q, motion_.v));
  v += upper();
  for (int k = 0; k < kRefinements; ++k) {
    phases_.enter(Phase::projection);
    solve(zero_, assembly_.velocity_error(motion_.q, motion_.v));
    v += upper();
    if (largest(upper()) <= bound) break;
  }
}

template <typename Scalar>
void Rattle<Scalar>::find_acceleration() {
  const Scalar bound = Scalar(4 / (settings_.step * settings_.step) * settings_.tolerance);
  phases_.enter(Phase::projection);
  solve(force_, assembly_.acceleration_term(motion_.q, motion_.v));
  motion_.a = upper();
  motion_.lambda = lower();
  for (int k = 0; k < kRefinements; ++k) {
    phases_.enter(Phase::projection);
    solve(zero_, assembly_.acceleration_error(motion_.q, motion_.v, motion_.a));
    motion_.a += upper();
    motion_.lambda += lower();
    if (largest(upper()) <= bound) break;
  }
}

template <typename Scalar>
void Rattle<Scalar>::solve(const Vector& upper, const Vector& minus_lower) {
  x_.head(upper.size()) = upper;
  x_.tail(minus_lower.size()) = -minus_lower;
  phases_.enter(Phase::solve);
  solver_.solve(x_);
  phases_.enter(Phase::other);
}

template class Rattle<double>;
template class Rattle<float>;

}  // namespace mbs::eigen_dense
