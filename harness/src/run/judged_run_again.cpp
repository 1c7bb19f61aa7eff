// Steps of a judged run that are done again: where its motion was lost, and what a step left.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "model_math/kinematics.hpp"
#include "model_math/largest.hpp"
#include "run/judged_run.hpp"

namespace mbs {
namespace {

using Clock = SampledTime::Clock;

bool is_trapezoidal(Scheme scheme) {
  return scheme == Scheme::penalty || scheme == Scheme::saddle_point;
}

/// The velocity v less what is at a right angle to `way`, weighted with M: so is what drivers give
/// to points, if constraints leave `way` free.
std::vector<double> along(const Model& model, std::vector<double> way,
                          const std::vector<double>& v) {
  std::vector<double> momentum(way.size());
  mass_times(model, way, momentum);
  const auto times = [&](const std::vector<double>& x) {
    return std::inner_product(momentum.begin(), momentum.end(), x.begin(), 0.0);
  };
  const double squared = times(way), share = squared == 0.0 ? 0.0 : times(v) / squared;
  for (double& x : way) x *= share;
  return way;
}

}  // namespace

/// The solution was found lost at `step`, for `reason`. Does the steps since the last good one
/// again and judges each, so that the summary has the first that was lost. False if none of them
/// was: with more states the judge knows better what its figures are small against. Its judgement
/// counts then.
bool JudgedRun::locate_loss(const std::string& reason, long step) {
  if (good_.step + 1 == step) {
    lose(judge_, reason, step);
    return true;
  }
  Judge judge = judge_;
  judge.take_back(good_.figures);
  State state = good_.state;
  Simulation& simulation = access_.again();
  simulation.set_state(state);
  for (long i = good_.step + 1; i <= step; ++i) {
    if (simulation.step().status == StepStatus::factorization_failed) {
      lose(judge_, reason, step);
      return true;
    }
    simulation.get_state(state);
    const std::string first = judge.judge(time(i), state);
    if (first.empty()) continue;
    judge_ = judge;  // its figures are those of the loss
    has_figures_ = true;
    lose(judge_, first, i);
    return true;
  }
  judge_ = judge;
  if (!access_.is_again_another) set_back_ = step;
  return false;
}

/// After a false alarm: does the steps again that were done since.
void JudgedRun::catch_up() {
  Simulation& simulation = access_.again();
  for (long i = *set_back_ + 1; i <= summary_.steps && !is_over_; ++i) {
    if (simulation.step().status != StepStatus::factorization_failed) continue;
    lose(RunStatus::diverged, kNotFactorized + hint(), time(i));
  }
  set_back_.reset();
}

/// The step at which the motion found to have jumped at `step` did so, by doing those since the
/// last sound look again; `step` if that does not show it.
long JudgedRun::first_across(long step) {
  const auto sound = std::lround(watch_.anchor_time() / settings_.step.step);
  if (sound + 1 >= step) return step;
  State state = watch_.anchor();
  Simulation& simulation = access_.again();
  simulation.set_state(state);
  for (long i = sound + 1; i < step; ++i) {
    if (simulation.step().status == StepStatus::factorization_failed) return step;
    simulation.get_state(state);
    if (watch_.is_across(time(i), state)) return i;
  }
  return step;
}

/// Where drivers lead points about, their velocity is no direction that errors go on in, and a part
/// of off_ is none. Half steps tell what is, unless off_ as a whole is too little to count.
void JudgedRun::add_led_errors(const Sample& sample) {
  const double negligible =
      0.1 * AccurateBounds{}.local_error * judge_.length() / static_cast<double>(steps_);
  if (!(largest_of(off_) <= negligible)) {
    if (!local_half_) {
      const auto begin = SampledTime::Clock::now();
      local_half_.emplace(access_.create, settings_.step);
      aside_ += SampledTime::since(begin);
    }
    off_ = local_half_->error(sample.before, sample.after);
  }
  local_errors_.add(off_, off_, settings_.step.step, sample.step - balanced_);
}

/// By some of the steps that are judged, 16 in a run or one in 1024: it takes as long as a few
/// steps. Not by those that cannot have left enough.
void JudgedRun::add_speed_error(const Sample& sample) {
  constexpr long kMost = 1024, kTimes = 16;
  const long step = sample.step, since = step - done_again_;
  if (!is_trapezoidal(settings_.step.scheme)) return;
  if (step != steps_ && since < std::min(kMost, steps_ / kTimes - interval_)) return;
  // Steps that were not projected as the others are not comparable.
  if (step % settings_.step.projections_every != 0) return;
  // Even if all steps left so much: the sum grows with the square of time.
  const double negligible = 0.1 * AccurateBounds{}.local_error * judge_.length() /
                            (static_cast<double>(steps_) * time(steps_));
  if (summary_.steps_at_limit == 0 && most_left(settings_.step) < negligible) {
    done_again_ = step;
    return;
  }
  const auto begin = Clock::now();
  if (!again_) {
    again_.emplace(access_.create, *access_.model, settings_.step,
                   static_cast<double>(summary_.passes) / static_cast<double>(summary_.steps));
  }
  const auto ready = Clock::now();  // its set-up is no more judging than that of the run is a step
  const SpeedError& error = again_->error(sample.before, sample.after, negligible);
  const std::vector<double>& v = judge_.velocity(sample.after);
  local_errors_.add_speed(error, is_led() ? along(scene_.model, error.now, v) : v,
                          settings_.step.step, since,
                          balance_ ? balance_->braked(time(step), sample.after) : 0.0);
  done_again_ = step;
  doing_again_ += SampledTime::since(ready);
  aside_ += SampledTime::since(begin);
}

}  // namespace mbs
