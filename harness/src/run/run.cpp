// The stepping loop around one implementation, with the harness's clocks and judgement.
#include "run/run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <new>

#include "printable.hpp"
#include "run/driver_end.hpp"
#include "run/half_step_run.hpp"
#include "run/initial_state.hpp"
#include "run/local_half_steps.hpp"
#include "run/scaled_equations.hpp"
#include "run/setting_names.hpp"
#include "usage_error.hpp"

namespace mbs {
namespace {

using Clock = std::chrono::steady_clock;

double microseconds(Clock::duration duration) {
  return std::chrono::duration<double, std::micro>(duration).count();
}

void fail(RunSummary& summary, RunStatus status, std::string reason, double t) {
  summary.status = status;
  summary.reason = std::move(reason);
  summary.failed_at = t;
}

/// What one run is made of.
struct Context {
  const Model& model;
  Simulation& simulation;
  const RunSettings& settings;
  Judge& judge;
  RunSummary& summary;
  std::optional<HalfStepRun>& half;
  std::optional<LocalHalfSteps>& local_half;
  [[nodiscard]] double time(long step) const { return step * settings.step.step; }
};

/// The last step at which the solution was not lost.
struct LastGood {
  long step;
  State state;
  Judge judge;
};

/// The solution was found lost at `step`, for `reason`. Does the steps since `good` again and
/// judges each, so that the summary has the first that was lost. False if none of them was: with
/// more states the judge knows better what its figures are small against. Its judgement counts
/// then.
bool locate_loss(const Context& run, const LastGood& good, long step, const std::string& reason) {
  const auto lost = [&run](long at, const Judge& judge, const std::string& why) {
    fail(run.summary, judge.off_branch() ? RunStatus::wrong_branch : RunStatus::diverged, why,
         run.time(at));
    return true;
  };
  if (good.step + 1 == step) return lost(step, run.judge, reason);
  Judge judge = good.judge;
  State state = good.state;
  run.simulation.set_state(state);
  for (long i = good.step + 1; i <= step; ++i) {
    if (run.simulation.step().status == StepStatus::factorization_failed) {
      return lost(step, run.judge, reason);
    }
    run.simulation.get_state(state);
    const std::string first = judge.judge(run.time(i), state);
    if (!first.empty()) return lost(i, judge, first);
  }
  run.judge = judge;
  return false;
}

/// The outcome of a run that went to its end.
void conclude(const Context& run) {
  RunSummary& summary = run.summary;
  const double share =
      static_cast<double>(summary.steps_at_limit) / static_cast<double>(summary.steps);
  if (share > RunBounds{}.pass_limit_share) {
    summary.status = RunStatus::not_converged;
    summary.reason = fmt::format("{} of {} steps ended at the limit of {} passes (allowed {:g} %)",
                                 summary.steps_at_limit, summary.steps,
                                 run.settings.step.max_passes, 100 * RunBounds{}.pass_limit_share);
    return;
  }
  summary.reason = run.judge.degradation();
  const double allowed = AccurateBounds{}.estimated_error * run.judge.length();
  const double local_allowed = AccurateBounds{}.local_error * run.judge.length();
  std::string estimated;
  if (run.half && !(run.half->position_error_max() <= allowed)) {
    estimated = fmt::format("estimated position error {:.1e} m (ok to {:.2g})",
                            run.half->position_error_max(), allowed);
  } else if (!(summary.local_error_sum.value_or(0.0) <= local_allowed)) {
    estimated = fmt::format(
        "local errors add up to {:.1e} m (ok to {:.2g}): a shorter step, or --half-step for a "
        "sharper estimate",
        *summary.local_error_sum, local_allowed);
  }
  if (!summary.reason.empty() && !estimated.empty()) summary.reason += ", ";
  summary.reason += estimated;
  if (!summary.reason.empty()) summary.status = RunStatus::degraded;
}

bool has_high_order(Scheme scheme) {
  return scheme == Scheme::rattle4 || scheme == Scheme::rattle6;
}

/// Whether the state is judged after step i: once in every `judge_every` steps, at uneven places,
/// so that a motion that repeats is not always met at the same one, and after the last.
bool is_judged(long i, long judge_every, long steps) {
  constexpr double kGoldenRatio = 0.6180339887498949;
  const long block = (i - 1) / judge_every;
  const double share = std::fmod(static_cast<double>(block + 1) * kGoldenRatio, 1.0);
  return i == steps || (i - 1) % judge_every == static_cast<long>(share * judge_every);
}

/// What one step left, m, sampled where the state is judged.
double local_error(const Context& run, const State& before, const State& after) {
  if (run.local_half) return run.local_half->error(before, after);
  return trapezoidal_error(run.model, before, after, run.settings.step.step);
}

/// Steps until the end or until the solution is lost.
void step_through(const Context& run, State& state, const Observer& observer,
                  std::vector<float>& times) {
  RunSummary& summary = run.summary;
  const long steps = count_steps(run.settings);
  times.reserve(static_cast<std::size_t>(steps));
  LastGood good{0, state, run.judge};
  const auto judged = [&](long i) { return is_judged(i, run.settings.judge_every, steps); };
  const bool local = !run.half && !run.judge.knows_exact_motion();  // nothing better tells
  State before = state;  // one step before the judged one
  double judge_us = 0.0;
  for (long i = 1; i <= steps; ++i) {
    auto begin = Clock::now();
    const StepOutcome outcome = run.simulation.step();
    const auto end = Clock::now();
    times.push_back(static_cast<float>(microseconds(end - begin)));
    summary.steps = i;
    summary.passes += outcome.passes;
    summary.factorizations += outcome.factorizations < 0 ? outcome.passes : outcome.factorizations;
    if (outcome.status == StepStatus::pass_limit) ++summary.steps_at_limit;
    if (outcome.status == StepStatus::factorization_failed) {
      const std::string why = "the tangent matrix could not be factorized";
      if (!locate_loss(run, good, i, why)) fail(summary, RunStatus::diverged, why, run.time(i));
      return;
    }
    if (run.half) run.half->advance();
    begin = Clock::now();
    if (judged(i)) {
      run.simulation.get_state(state);
      const std::string lost = run.judge.judge(run.time(i), state);
      if (!lost.empty() && locate_loss(run, good, i, lost)) return;
      if (local) {
        run.judge.add_local_error(local_error(run, before, state), state, run.settings.step.step,
                                  i - good.step);
      }
      good = {i, state, run.judge};
    }
    if (local && i < steps && judged(i + 1)) run.simulation.get_state(before);
    judge_us += microseconds(Clock::now() - begin);
    if ((observer || run.half) && !judged(i)) run.simulation.get_state(state);
    if (run.half) run.half->compare(state);
    summary.judge_us = judge_us / static_cast<double>(i);
    if (observer) observer(i, run.time(i), state);
  }
  if (local) summary.local_error_sum = run.judge.local_error_sum();
  conclude(run);
}

/// Simulates the whole motion again, from the same start, for the times of its steps alone.
void repeat(Simulation& simulation, const State& start, std::vector<float>& least) {
  simulation.set_state(start);
  for (float& time : least) {
    const auto begin = Clock::now();
    if (simulation.step().status == StepStatus::factorization_failed) return;
    time = std::min(time, static_cast<float>(microseconds(Clock::now() - begin)));
  }
}

}  // namespace

std::string to_string(RunStatus status) {
  switch (status) {
    case RunStatus::ok:
      return "ok";
    case RunStatus::degraded:
      return "degraded";
    case RunStatus::not_converged:
      return "not-converged";
    case RunStatus::diverged:
      return "diverged";
    case RunStatus::wrong_branch:
      return "wrong-branch";
    case RunStatus::unsupported:
      return "unsupported";
  }
  return "unknown";
}

long count_steps(const RunSettings& settings) {
  const auto require = [](double value, const char* name, const char* unit) {
    if (!(value > 0.0) || !std::isfinite(value)) {
      throw UsageError(
          fmt::format("{} is {:g}{}: it must be a finite number above 0", name, value, unit));
    }
  };
  require(settings.step.step, "--step", " s");
  require(settings.duration, "--duration", " s");
  if (settings.judge_every < 1) {
    throw UsageError(
        fmt::format("--judge-every is {}: it must be at least 1", settings.judge_every));
  }
  if (settings.repeats < 1 || settings.repeats > 1000) {
    throw UsageError(fmt::format("--repeats is {}: it must be 1 to 1000", settings.repeats));
  }
  if (settings.deadline_us) require(*settings.deadline_us, "--deadline-us", "");
  require(settings.step.penalty, "--penalty", "");
  require(settings.step.tolerance, "--tolerance", " m");
  if (settings.step.max_passes < 1 || settings.step.max_passes > 1000) {
    throw UsageError(
        fmt::format("--max-passes is {}: it must be 1 to 1000", settings.step.max_passes));
  }
  constexpr double kMostSteps = 1e8;
  const double steps = std::round(settings.duration / settings.step.step);
  if (steps < 1.0) {
    throw UsageError(fmt::format("--duration {:g} s is shorter than half a step of {:g} s",
                                 settings.duration, settings.step.step));
  }
  if (!(steps <= kMostSteps)) {
    throw UsageError(fmt::format("--duration {:g} s takes {:g} steps of {:g} s: at most {:g}",
                                 settings.duration, steps, settings.step.step, kMostSteps));
  }
  return static_cast<long>(steps);
}

void require_duration(const Scene& scene, const RunSettings& settings) {
  require_drivers(scene, settings.step.step, count_steps(settings));
}

RunSummary run(const Scene& scene, const Variant& variant, const RunSettings& settings,
               const Observer& observer) {
  require_duration(scene, settings);
  RunSummary summary;
  State state = initial_state(scene.model);
  Judge judge(scene, state, 0.0);
  std::vector<float> times;
  std::optional<HalfStepRun> half;
  std::optional<LocalHalfSteps> local_half;
  std::optional<ScaledEquations> scaled;
  try {
    const auto begin = Clock::now();
    if (settings.scale_equations) scaled.emplace(scene.model);
    const auto create = [&] {
      return scaled ? scaled->create(variant, scene.model, settings.step)
                    : create_simulation(variant, scene.model, settings.step);
    };
    const auto simulation = create();
    simulation->set_state(state);
    summary.setup_us = microseconds(Clock::now() - begin);
    if (observer) observer(0, 0.0, state);
    if (settings.half_step) half.emplace(scene, variant, *settings.half_step, state);
    if (has_high_order(settings.step.scheme)) local_half.emplace(scene, variant, settings.step);
    step_through({scene.model, *simulation, settings, judge, summary, half, local_half}, state,
                 observer, times);
    if (settings.repeats > 1) {
      std::vector<float> least = times;
      for (int run = 1; run < settings.repeats; ++run) {
        repeat(*create(), initial_state(scene.model), least);
      }
      summary.least_us = step_times(least, settings.deadline_us);
    }
  } catch (const Unsupported& reason) {
    summary.status = RunStatus::unsupported;
    summary.reason = printable(reason.what(), 1000);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    summary.status = RunStatus::diverged;
    summary.reason = fmt::format("the implementation threw: {}", printable(error.what(), 1000));
    summary.failed_at = (summary.steps + 1) * settings.step.step;
  }
  summary.step_us = step_times(times, settings.deadline_us);
  if (half) summary.position_error_estimate = half->position_error_max();
  summary.position_error_max = judge.position_error_max();
  summary.energy_drift_max = judge.energy_drift_max();
  summary.constraint_violation_max = judge.constraint_violation_max();
  return summary;
}

}  // namespace mbs
