// One stage of RATTLE: Eq. (14).
#include "rattle_stage.hpp"

#include "largest.hpp"

namespace mbs::eigen_dense {

namespace {

constexpr int kRefinements = 5;

}  // namespace

template <typename Scalar>
RattleStage<Scalar>::RattleStage(const Model& model, const StepSettings& settings,
                                 PhaseClock& phases)
    : settings_(settings),
      phases_(phases),
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
  assembly_.mass(solver_.leading());
  solver_.factorize_leading();
  refresh();
  find_acceleration();
}

template <typename Scalar>
void RattleStage<Scalar>::set(const State& state) {
  motion_.set(state);
  refresh();
  find_acceleration();
}

template <typename Scalar>
bool RattleStage<Scalar>::advance(Scalar h, StepOutcome& outcome) {
  if (!factorized_) return false;
  move(h, outcome);
  ++outcome.factorizations;
  if (!refresh()) return false;
  find_velocity(h);
  find_acceleration();
  return true;
}

// Keeps q' − q apart from q', which is rounded to the last digit of q: in float those digits would
// drive w away from the motion.
template <typename Scalar>
void RattleStage<Scalar>::move(Scalar h, StepOutcome& outcome) {
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
bool RattleStage<Scalar>::refresh() {
  phases_.enter(Phase::evaluation);
  assembly_.evaluate(motion_.q);
  assembly_.scaled_force(motion_.q, motion_.v, force_);
  force_ *= Scalar(4 / (settings_.step * settings_.step));
  phases_.enter(Phase::assembly);
  solver_.coupling() = assembly_.jacobian_transposed();  // Eq. (14)
  phases_.enter(Phase::factorization);
  factorized_ = solver_.factorize();
  phases_.enter(Phase::other);
  return factorized_;
}

// Solves for v' − w instead of v': [(h/2) Q; −Φq w] for [M w + (h/2) Q; 0] on the right.
template <typename Scalar>
void RattleStage<Scalar>::find_velocity(Scalar h) {
  auto v = motion_.v.head(motion_.a.size());
  phases_.enter(Phase::projection);
  v = change_ / h;
  impulse_ = h / 2 * force_;
  solve(impulse_, assembly_.velocity_error(motion_.v));
  v += upper();
  refine_velocity();
}

template <typename Scalar>
void RattleStage<Scalar>::refine_velocity() {
  const Scalar bound = Scalar(2 / settings_.step * settings_.tolerance);
  auto v = motion_.v.head(motion_.a.size());
  for (int k = 0; k < kRefinements; ++k) {
    phases_.enter(Phase::projection);
    solve(zero_, assembly_.velocity_error(motion_.v));
    v += upper();
    if (largest(upper()) <= bound) break;
  }
}

template <typename Scalar>
void RattleStage<Scalar>::find_acceleration() {
  const Scalar bound = Scalar(4 / (settings_.step * settings_.step) * settings_.tolerance);
  phases_.enter(Phase::projection);
  solve(force_, assembly_.acceleration_term(motion_.v));
  motion_.a = upper();
  motion_.lambda = lower();
  for (int k = 0; k < kRefinements; ++k) {
    phases_.enter(Phase::projection);
    solve(zero_, assembly_.acceleration_error(motion_.v, motion_.a));
    motion_.a += upper();
    motion_.lambda += lower();
    if (largest(upper()) <= bound) break;
  }
}

template <typename Scalar>
void RattleStage<Scalar>::solve(const Vector& upper, const Vector& minus_lower) {
  x_.head(upper.size()) = upper;
  x_.tail(minus_lower.size()) = -minus_lower;
  phases_.enter(Phase::solve);
  solver_.solve(x_);
  phases_.enter(Phase::other);
}

template class RattleStage<double>;
template class RattleStage<float>;

}  // namespace mbs::eigen_dense
