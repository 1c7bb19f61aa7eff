// The timed loop and everything around it.
#include "bench/measurement.hpp"

#include <fmt/format.h>
#include <malloc.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <new>
#include <vector>

#include "run/judge.hpp"
#include "run/setting_names.hpp"

namespace mbs {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

struct Tally {
  long passes = 0;
  long steps_at_limit = 0;
  long failed_step = 0;  ///< 1 for the first; 0 if none
};

/// The timed region: steps, and sums of their outcomes.
Tally run_steps(Simulation& simulation, long steps) {
  Tally tally;
  for (long i = 1; i <= steps; ++i) {
    const StepOutcome outcome = simulation.step();
    tally.passes += outcome.passes;
    if (outcome.status == StepStatus::converged) continue;
    if (outcome.status == StepStatus::factorization_failed) {
      tally.failed_step = i;
      break;
    }
    ++tally.steps_at_limit;
  }
  return tally;
}

/// Bytes that malloc has given out: what everything written in C, C++ or Fortran holds.
double allocated_bytes() {
  const auto info = mallinfo2();
  return static_cast<double>(info.uordblks) + static_cast<double>(info.hblkhd);
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

std::string failure_text() {
  try {
    throw;
  } catch (const CellFailure& failure) {
    return failure.what();
  } catch (const Unsupported& reason) {
    return fmt::format("unsupported: {}", reason.what());
  } catch (const std::bad_alloc&) {
    return "out-of-memory: an allocation failed";
  } catch (const std::exception& error) {
    return fmt::format("error: {}", error.what());
  }
}

void Measurement::prepare() {
  if (failure_) throw CellFailure(*failure_);
  if (simulation_) return;
  try {
    try_to_prepare();
  } catch (const std::exception&) {
    failure_ = failure_text();
  }
  if (!failure_) return;
  release();
  throw CellFailure(*failure_);
}

void Measurement::try_to_prepare() {
  constexpr int kSetupSamples = 5;
  const double before = allocated_bytes();
  set_up(prepared_before_ ? 1 : kSetupSamples);
  time_stretch();
  if (!prepared_before_) figures_.memory_bytes = allocated_bytes() - before;
  if (prepared_before_) return;
  if (!task_.control) judge_end();
  if (task_.phases) profile();
  prepared_before_ = true;
}

void Measurement::set_up(int samples) {
  std::vector<double> times;
  for (int i = 0; i < samples; ++i) {
    simulation_.reset();
    const auto begin = Clock::now();
    simulation_ = create_simulation(task_.variant, task_.scene.model, task_.settings);
    simulation_->set_state(task_.stretch.initial);
    times.push_back(1e6 * seconds_since(begin));
  }
  if (!prepared_before_) figures_.setup_us = median(times);
}

double Measurement::time_stretch() {
  simulation_->set_state(task_.stretch.initial);
  const auto begin = Clock::now();
  const Tally tally = run_steps(*simulation_, task_.stretch.steps);
  const double seconds = seconds_since(begin);
  if (tally.failed_step > 0) {
    failure_ = fmt::format("factorization-failed: the tangent of step {} of {} was refused",
                           tally.failed_step, task_.stretch.steps);
    throw CellFailure(*failure_);
  }
  figures_.passes = tally.passes;
  figures_.steps_at_limit = tally.steps_at_limit;
  return seconds;
}

void Measurement::judge_end() {
  const Stretch& stretch = task_.stretch;
  Judge judge(task_.scene, stretch.initial, stretch.start);
  State state;
  simulation_->get_state(state);
  const double end = stretch.start + static_cast<double>(stretch.steps) * task_.settings.step;
  const std::string lost = judge.judge(end, state);
  if (!lost.empty()) {
    throw CellFailure(fmt::format("diverged: {} at {:g} s, the end of the stretch", lost, end));
  }
  figures_.position_error = judge.position_error_max();
  figures_.constraint_violation = judge.constraint_violation_max();
  figures_.energy_drift = judge.energy_drift_max();
}

void Measurement::require_finite() {
  State state;
  simulation_->get_state(state);
  const auto finite = [](double x) { return std::isfinite(x); };
  if (task_.control) return;  // it computes nothing
  if (std::ranges::all_of(state.q, finite) && std::ranges::all_of(state.v, finite) &&
      std::ranges::all_of(state.a, finite) && std::ranges::all_of(state.lambda, finite)) {
    return;
  }
  failure_ = "diverged: the state is not finite after a timed stretch";
  throw CellFailure(*failure_);
}

void Measurement::profile() {
  simulation_->set_state(task_.stretch.initial);
  simulation_->phases().start();
  run_steps(*simulation_, task_.stretch.steps);
  simulation_->phases().stop();
  const auto& ticks = simulation_->phases().ticks();
  double total = 0.0;
  for (const std::uint64_t phase : ticks) total += static_cast<double>(phase);
  std::array<double, kPhaseCount> shares{};
  for (std::size_t i = 0; i < shares.size(); ++i) {
    shares[i] = total > 0.0 ? static_cast<double>(ticks[i]) / total : 0.0;
  }
  figures_.phases = shares;
}

}  // namespace mbs
