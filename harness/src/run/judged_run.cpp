// Judgement after each step.
#include "run/judged_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>
#include <span>
#include <utility>

#include "model_math/kinematics.hpp"
#include "printable.hpp"
#include "usage_error.hpp"

namespace mbs {
namespace {

bool has_high_order(Scheme scheme) {
  return scheme == Scheme::rattle4 || scheme == Scheme::rattle6 || scheme == Scheme::multistep6;
}

/// How many states are judged together. Judging a small one takes less time than bringing code and
/// data into the caches, out of which the steps in between have pushed them. Who looks at each step
/// is not to see many that are lost.
std::size_t judged_together(const Scene& scene, const RunSettings& settings, bool is_observed) {
  constexpr int kMost = 8, kVariables = 1024;
  if (is_observed || settings.half_step || settings.judge_every) return 1;
  const int fitting = kVariables / std::max(1, scene.model.variables());
  return static_cast<std::size_t>(std::clamp(fitting, 1, kMost));
}

}  // namespace

JudgedRun::JudgedRun(const Scene& scene, const RunSettings& settings, State start,
                     Observer observer)
    : scene_(scene),
      settings_(settings),
      observer_(std::move(observer)),
      steps_(count_steps(settings)),
      interval_(judge_interval(scene, settings)),
      next_look_(steps_ + 1),
      state_(std::move(start)),
      samples_(judged_together(scene, settings, observer_ != nullptr), Sample{0, state_, state_}),
      judge_(scene, state_, 0.0),
      good_{0, state_, judge_.figures()},
      watch_(scene, state_, judge_.length(), !judge_.knows_exact_motion()),
      quarter_turn_(scene),
      local_errors_(scene, judge_.length(), watch_.passes_on()),
      forces_(scene),
      adds_local_errors_(watch_.freedoms() > 0),
      is_driven_(is_driven(scene.model)) {}

void JudgedRun::begin(Access access) {
  access_ = std::move(access);
  next_judged_ = judged_after(0, state_);
  if (watch_.is_needed()) next_look_ = looked_after(state_);
  if (adds_local_errors_ && !is_conservative(scene_.model)) balance_.emplace(scene_);
  if (observer_) observer_(0, 0.0, state_);
  if (settings_.half_step) {
    half_.emplace(scene_, access_.create, *settings_.half_step, state_, judge_.length());
  }
  if (adds_local_errors_ && has_high_order(settings_.step.scheme)) {
    local_half_.emplace(access_.create, settings_.step);
  }
}

double JudgedRun::time(long step) const { return static_cast<double>(step) * settings_.step.step; }

/// The first step after `step` of one in every `interval` steps, at uneven places, so that a motion
/// that repeats is not always met at the same one, and the last.
long JudgedRun::uneven_after(long step, long interval) const {
  constexpr double kGoldenRatio = 0.6180339887498949;
  for (long block = step == 0 ? 0 : (step - 1) / interval;; ++block) {
    const double turned = static_cast<double>(block + 1) * kGoldenRatio;
    const double share = turned - std::floor(turned);
    const long place = static_cast<long>(share * static_cast<double>(interval));
    const long judged = std::min(steps_, block * interval + place + 1);
    if (judged > step || judged == steps_) return judged;
  }
}

/// The next one after `step`, whose state this is: before torsions have turned so far that whole
/// turns could be mistaken.
long JudgedRun::judged_after(long step, const State& state) {
  const long latest = uneven_after(step, interval_);
  if (!quarter_turn_.is_needed()) return latest;
  looking_.begin();
  const double steps = quarter_turn_.time(time(step), state) / settings_.step.step;
  looking_.end();
  const auto most = static_cast<double>(latest - step);
  return step + static_cast<long>(std::clamp(steps, 1.0, std::max(1.0, most)));
}

void JudgedRun::count(const StepOutcome& outcome) {
  ++summary_.steps;
  summary_.passes += outcome.passes;
  summary_.factorizations += outcome.factorizations < 0 ? outcome.passes : outcome.factorizations;
  if (outcome.status == StepStatus::pass_limit) ++summary_.steps_at_limit;
}

void JudgedRun::take(const StepOutcome& outcome) {
  count(outcome);
  const long step = summary_.steps;
  if (outcome.status == StepStatus::factorization_failed) {
    judge_samples();
    if (is_over_) return;
    if (!locate_loss(kNotFactorized, step)) {
      lose(RunStatus::diverged, kNotFactorized + hint(), time(step));
    }
    return;
  }
  if (half_) half_->advance();
  const bool is_judged = step == next_judged_;
  if (is_judged) {
    samples_[waiting_].step = step;
    copy(samples_[waiting_].after);
    next_judged_ = judged_after(step, samples_[waiting_].after);
    ++waiting_;
    // A step at the limit may be one of a motion that is lost, of which each takes long.
    const bool is_doubtful = outcome.status == StepStatus::pass_limit;
    if (waiting_ == samples_.size() || step == steps_ || is_doubtful) judge_samples();
    if (set_back_ && !is_over_) catch_up();
    if (is_over_) return;
  }
  const bool is_before = adds_local_errors_ && step < steps_ && step + 1 == next_judged_;
  constexpr long kBetween = 8;  // steps: what a jump changed is still there a little later
  const bool is_looked_at =
      watch_.is_needed() && (step >= next_look_ || step == steps_ ||
                             (step >= last_look_ + kBetween && is_unusual(outcome)));
  if (!is_judged && !is_before && !is_looked_at && !half_ && !observer_) return;
  State& now = is_before ? samples_[waiting_].before : state_;
  if (is_before || (is_looked_at && !is_judged)) {
    copy(now);
  } else if ((observer_ || half_) && !is_judged) {
    access_.get_state(now);
  }
  const State& last_judged = waiting_ == 0 ? good_.state : samples_[waiting_ - 1].after;
  const State& present = is_judged ? last_judged : now;
  if (is_looked_at) look(present);
  if (is_over_) return;
  if (half_) half_->compare(present);
  if (observer_) observer_(step, time(step), present);
  if (step == steps_) conclude();
}

void JudgedRun::copy(State& state) {
  copying_.begin();
  access_.get_state(state);
  copying_.end();
}

void JudgedRun::judge_samples() {
  judging_.begin();
  aside_ = 0.0;
  for (std::size_t i = 0; i < waiting_ && !is_over_; ++i) judge(samples_[i]);
  waiting_ = 0;
  judging_.end(aside_);
}

void JudgedRun::judge(Sample& sample) {
  const long step = sample.step;
  std::string lost = judge_.judge(time(step), sample.after);
  has_figures_ = true;
  if (!lost.empty()) {
    const auto begin = SampledTime::Clock::now();
    if (!locate_loss(lost, step)) {
      // Where another simulation did the steps again, this state itself is still to be judged.
      lost = judge_.judge(time(step), sample.after);
      if (!lost.empty()) lose(judge_, lost, step);
    }
    aside_ += SampledTime::since(begin);
  }
  if (is_over_) return;
  if (adds_local_errors_) add_local_errors(sample);
  balance_energy(sample);
  ++judgements_;
  good_.step = step;
  std::swap(good_.state, sample.after);
  good_.figures = judge_.figures();
  constexpr long kCompared = 8;  // times a run: each takes as long as some steps
  if (forces_.is_needed() && step >= next_compared_) {
    forces_.compare(time(step), good_.state);
    next_compared_ = uneven_after(step, std::max(1L, steps_ / kCompared));
  }
  note_beyond(step);
}

/// Whether the motion went on as another assembly.
void JudgedRun::look(const State& present) {
  looking_.begin();
  const long step = summary_.steps;
  const std::string jump = watch_.look(time(step), present);
  if (!jump.empty()) {
    judge_samples();
    if (is_over_) return;
    const long first = first_across(step);
    std::string reason = jump;
    if (watch_.step_needed()) {
      reason += fmt::format("; --step {:.1g} would be short enough there", *watch_.step_needed());
    } else {
      reason += "; a shorter --step may follow them";
    }
    lose(RunStatus::wrong_branch, std::move(reason), time(first));
    return;
  }
  last_look_ = step;
  next_look_ = step + looked_after(present);
  looking_.end();
}

/// Whether the step was harder than most: near a singular position Newton needs more passes.
bool JudgedRun::is_unusual(const StepOutcome& outcome) const {
  return outcome.status == StepStatus::pass_limit ||
         2 * outcome.passes * summary_.steps > 3 * summary_.passes + 2 * summary_.steps;
}

/// Steps until the next look: as many as leave no time to jump there and back, half the judged
/// length by speed and acceleration of the fastest point, and at most 256.
long JudgedRun::looked_after(const State& present) const {
  constexpr double kWay = 0.5;  // of the length
  constexpr long kMost = 256;
  const double length = watch_.length();
  double speed = 0.0, acceleration = 0.0;
  for (const double v : present.v) speed = std::max(speed, std::abs(v));
  for (const double a : present.a) acceleration = std::max(acceleration, std::abs(a));
  const double t = time_to_go(kWay * length, speed, acceleration);
  return static_cast<long>(std::clamp(t / settings_.step.step, 1.0, double{kMost}));
}

/// About every 256 steps, and one in four of those that are judged: for what takes as long as all
/// else.
bool JudgedRun::is_in_turn(long step) const {
  const long every = std::clamp(256L / interval_, 1L, 4L);
  return judgements_ % every == every / 2 || step == steps_;
}

void JudgedRun::balance_energy(const Sample& sample) {
  const long step = sample.step;
  if (judge_.judges_energy()) {  // as long as it is carried along evenly
    balanced_ = step;
    return;
  }
  if (!balance_ || !is_in_turn(step)) return;
  const auto [excess, work] =
      balance_->over(sample.before, sample.after, time(step), settings_.step.step);
  judge_.add_balance(excess, work, step - balanced_);
  balanced_ = step;
}

/// What the last step left stands for those since the last judged one.
void JudgedRun::add_local_errors(const Sample& sample) {
  const long steps = sample.step - good_.step;
  const double step = settings_.step.step;
  const std::vector<double>& v = judge_.velocity(sample.after);
  off_.resize(v.size());
  if (has_high_order(settings_.step.scheme)) {
    off_ = local_half_->error(sample.before, sample.after);
  } else {  // the trapezoidal rule
    for (std::size_t i = 0; i < off_.size(); ++i) {
      off_[i] = step * step / 12 * (sample.after.a[i] - sample.before.a[i]);
    }
  }
  if (is_led()) {
    judge_.add_time(static_cast<double>(steps) * step, 0.0);
    if (is_in_turn(sample.step)) add_led_errors(sample);
    add_speed_error(sample);
    return;
  }
  const double speed = local_errors_.add(off_, v, step, steps);
  judge_.add_time(static_cast<double>(steps) * step, speed);
  add_speed_error(sample);
}

std::string JudgedRun::hint() const {
  return settings_.step.scheme == Scheme::multistep6
             ? " (multistep6 cannot pass singular positions: if there is one, try rattle)"
             : "";
}

void JudgedRun::lose(const Judge& judge, const std::string& reason, long step) {
  lose(judge.off_branch() ? RunStatus::wrong_branch : RunStatus::diverged, reason + hint(),
       time(step));
}

void JudgedRun::lose(RunStatus status, std::string reason, std::optional<double> t) {
  summary_.status = status;
  summary_.reason = std::move(reason);
  summary_.failed_at = t;
  is_over_ = true;
}

void JudgedRun::take_exception() {
  try {
    throw;
  } catch (const Unsupported& reason) {
    lose(RunStatus::unsupported, printable(reason.what(), 1000), std::nullopt);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const UsageError&) {
    throw;
  } catch (const std::exception& error) {
    // Without the simulation, which may be gone.
    for (const Sample& sample : std::span(samples_).first(std::exchange(waiting_, 0))) {
      if (sample.step <= good_.step) continue;
      const std::string lost = judge_.judge(time(sample.step), sample.after);
      has_figures_ = true;
      if (lost.empty()) continue;
      lose(judge_, lost, sample.step);
      return;
    }
    lose(RunStatus::diverged,
         fmt::format("the implementation threw: {}", printable(error.what(), 1000)),
         time(summary_.steps + 1));
  }
}

RunSummary JudgedRun::finish() {
  const double judging =
      copying_.total() + judging_.total() + looking_.total() + doing_again_;  // s
  summary_.judge_us = judging * 1e6 / static_cast<double>(std::max(1L, summary_.steps));
  if (half_) summary_.position_error_estimate = half_->position_error_max();
  if (!has_figures_) judge_.spoil();  // those of the start say nothing of the run
  summary_.position_error_max = judge_.position_error_max();
  summary_.energy_drift_max = judge_.energy_drift_max();
  summary_.imbalance_max = judge_.imbalance_max();
  if (balance_ && !summary_.energy_drift_max && !summary_.imbalance_max) {  // lost before a look
    summary_.imbalance_max = std::numeric_limits<double>::infinity();
  }
  summary_.constraint_violation_max = judge_.constraint_violation_max();
  return summary_;
}

}  // namespace mbs
