// The stepping loop around one implementation, with the harness's clocks.
#include "run/run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>

#include "registry/factory.hpp"
#include "run/driver_end.hpp"
#include "run/initial_state.hpp"
#include "run/judged_run.hpp"
#include "run/scaled_equations.hpp"
#include "usage_error.hpp"

namespace mbs {
namespace {

using Clock = std::chrono::steady_clock;

double microseconds(Clock::duration duration) {
  return std::chrono::duration<double, std::micro>(duration).count();
}

/// Steps of `step` s until the end or until the solution is lost.
void step_through(Simulation& simulation, JudgedRun& judged, double step, const Follower& follower,
                  std::vector<float>& times) {
  while (!judged.is_over()) {
    const auto begin = Clock::now();
    const StepOutcome outcome = simulation.step();
    times.push_back(static_cast<float>(microseconds(Clock::now() - begin)));
    judged.take(outcome);
    if (follower) follower(static_cast<double>(times.size()) * step);
  }
}

/// A hundred times what reading the clock takes (46 ns measured), us.
constexpr double kLeastTimed = 5.0;

/// Steps that are timed together when the motion is repeated: one, if it takes long enough itself.
std::size_t timed_together(std::vector<float> times) {
  const auto middle = times.begin() + static_cast<std::ptrdiff_t>(times.size() / 2);
  std::nth_element(times.begin(), middle, times.end());
  return static_cast<std::size_t>(std::ceil(kLeastTimed / std::max(double{*middle}, 1e-3)));
}

/// `times` as they are when a block's steps, `together` of them, share its time alike.
std::vector<float> by_block(std::vector<float> times, std::size_t together) {
  for (std::size_t begin = 0; begin < times.size(); begin += together) {
    const auto first = times.begin() + static_cast<std::ptrdiff_t>(begin);
    const std::size_t steps = std::min(together, times.size() - begin);
    const auto last = first + static_cast<std::ptrdiff_t>(steps);
    std::fill(first, last, std::accumulate(first, last, 0.0F) / static_cast<float>(steps));
  }
  return times;
}

/// Simulates the whole motion again, from the same start, for the times of its steps alone.
void repeat(Simulation& simulation, const State& start, std::size_t together,
            std::vector<float>& least) {
  simulation.set_state(start);
  for (std::size_t first = 0; first < least.size(); first += together) {
    const std::size_t last = std::min(first + together, least.size());
    const auto begin = Clock::now();
    for (std::size_t step = first; step < last; ++step) {
      if (simulation.step().status == StepStatus::factorization_failed) return;
    }
    const double time = microseconds(Clock::now() - begin) / static_cast<double>(last - first);
    for (std::size_t step = first; step < last; ++step) {
      least[step] = std::min(least[step], static_cast<float>(time));
    }
  }
}

}  // namespace

const std::vector<Outcome>& outcomes() {
  static const std::vector<Outcome> all{
      {RunStatus::ok, "ok",
       "within bounds; the position error is known (exact motion) or estimated (--half-step)"},
      {RunStatus::plausible, "plausible",
       "nothing is known to be wrong, but the position error is not known for sure"},
      {RunStatus::degraded, "degraded", "simulated to its end, but less accurate than ok allows"},
      {RunStatus::not_converged, "not-converged", "too many steps ended at the pass limit"},
      {RunStatus::diverged, "diverged", "the solution was lost; a shorter step often helps"},
      {RunStatus::wrong_branch, "wrong-branch",
       "the mechanism went on as another assembly that its constraints allow"},
      {RunStatus::unsupported, "unsupported",
       "the implementation does not offer this scene or these settings"}};
  return all;
}

std::string to_string(RunStatus status) {
  return std::ranges::find(outcomes(), status, &Outcome::status)->name;
}

bool is_finished(RunStatus status) {
  return status == RunStatus::ok || status == RunStatus::plausible || status == RunStatus::degraded;
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
  if (settings.judge_every && *settings.judge_every < 1) {
    throw UsageError(
        fmt::format("--judge-every is {}: it must be at least 1", *settings.judge_every));
  }
  if (settings.repeats < 1 || settings.repeats > 1000) {
    throw UsageError(fmt::format("--repeats is {}: it must be 1 to 1000", settings.repeats));
  }
  if (settings.deadline_us) require(*settings.deadline_us, "--deadline-us", " us");
  require(settings.step.penalty, "--penalty", "");
  require(settings.step.tolerance, "--tolerance", " m");
  if (settings.step.max_passes < 1 || settings.step.max_passes > 1000) {
    throw UsageError(
        fmt::format("--max-passes is {}: it must be 1 to 1000", settings.step.max_passes));
  }
  constexpr double kMostSteps = 1e8;
  const double steps = std::round(settings.duration / settings.step.step);
  if (settings.duration < settings.step.step * (1 - 1e-9)) {
    throw UsageError(
        fmt::format("--duration {:g} s is shorter than one step: it must be at least "
                    "--step, {:g} s",
                    settings.duration, settings.step.step));
  }
  if (!(steps <= kMostSteps)) {
    throw UsageError(fmt::format("--duration {:g} s takes {:g} steps of {:g} s: at most {:g}",
                                 settings.duration, steps, settings.step.step, kMostSteps));
  }
  return static_cast<long>(steps);
}

long judge_interval(const Scene& scene, const RunSettings& settings) {
  if (settings.judge_every) return *settings.judge_every;
  const long steps = count_steps(settings);
  if (scene.four_bar_loops) return std::clamp(steps / 32, 1L, 256L);
  return std::max(std::clamp(steps / 32, 1L, 64L), std::min(steps / 128, 128L));
}

void require_duration(const Scene& scene, const RunSettings& settings) {
  require_drivers(scene, settings.step.step, count_steps(settings));
}

RunSummary run(const Scene& scene, const Variant& variant, const RunSettings& settings,
               const Observer& observer, const Follower& follower) {
  require_duration(scene, settings);
  const State start = initial_state(scene.model);
  std::optional<ScaledEquations> scaled;  // before `judged`, which has simulations of them
  JudgedRun judged(scene, settings, start, observer);
  std::vector<float> times, least;
  double setup_us = 0.0;
  try {
    const auto begin = Clock::now();
    if (settings.scale_equations) scaled.emplace(scene.model);
    const auto create = [&](const StepSettings& step) {
      return scaled ? scaled->create(variant, scene.model, step)
                    : create_simulation(variant, scene.model, step);
    };
    const auto simulation = create(settings.step);
    simulation->set_state(start);
    setup_us = microseconds(Clock::now() - begin);
    judged.begin({[&](State& state) { simulation->get_state(state); },
                  [&]() -> Simulation& { return *simulation; }, create,
                  scaled ? &scaled->model() : &scene.model});
    times.reserve(static_cast<std::size_t>(count_steps(settings)));
    step_through(*simulation, judged, settings.step.step, follower, times);
    if (settings.repeats > 1 && !times.empty()) {
      const std::size_t together = timed_together(times);
      least = by_block(times, together);
      for (int run = 1; run < settings.repeats; ++run) {
        repeat(*create(settings.step), start, together, least);
      }
    }
  } catch (...) {
    judged.take_exception();
    least.clear();
  }
  RunSummary summary = judged.finish();
  summary.setup_us = setup_us;
  summary.step_us = step_times(times, settings.deadline_us);
  if (!least.empty()) summary.least_us = step_times(least, settings.deadline_us);
  return summary;
}

}  // namespace mbs
