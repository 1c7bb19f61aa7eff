// The timed loop and everything around it.
#include "bench/measurement.hpp"

#include <fmt/format.h>
#include <malloc.h>
#include <time.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <new>
#include <vector>

#include "bench/paired_ratio.hpp"
#include "printable.hpp"
#include "registry/factory.hpp"
#include "run/judge.hpp"

namespace mbs {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// Of all threads, so that none works for nothing.
double cpu_seconds() {
  timespec now{};
  ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// What reading the clocks costs of the processor time between two readings, s.
double reading_cost() {
  constexpr int kTries = 200;
  double least = 1.0;
  for (int i = 0; i < kTries; ++i) {
    const double cpu = cpu_seconds();
    const auto begin = Clock::now();
    const double seconds = seconds_since(begin);
    least = std::min(least, cpu_seconds() - cpu - seconds);
  }
  return std::max(0.0, least);
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

}  // namespace

std::string failure_text() {
  constexpr std::size_t kLongest = 500;
  try {
    throw;
  } catch (const CellFailure& failure) {
    return failure.what();
  } catch (const Unsupported& reason) {
    return fmt::format("unsupported: {}", printable(reason.what(), kLongest));
  } catch (const std::bad_alloc&) {
    return "out-of-memory: an allocation failed";
  } catch (const std::exception& error) {
    return fmt::format("error: {}", printable(error.what(), kLongest));
  } catch (...) {
    return "error: it threw what is no std::exception";
  }
}

Spent& Spent::operator+=(const Spent& more) {
  seconds += more.seconds;
  cpu_seconds += more.cpu_seconds;
  return *this;
}

void Measurement::set_up() {
  constexpr int kSamples = 5;
  constexpr double kEnough = 1.0;  // s; large scenes are not set up again and again
  const double before = allocated_bytes();
  std::vector<double> times;
  const auto first = Clock::now();
  while (times.size() < kSamples && (times.empty() || seconds_since(first) < kEnough)) {
    simulation_.reset();
    const auto begin = Clock::now();
    simulation_ = create_simulation(task_.variant, task_.scene.model, task_.settings);
    simulation_->set_state(task_.stretch.initial);
    times.push_back(1e6 * seconds_since(begin));
  }
  figures_.setup_us = median(times);
  figures_.memory_bytes = allocated_bytes() - before;
}

void Measurement::start() {
  simulation_->set_state(task_.stretch.initial);
  done_ = 0;
  figures_.passes = figures_.steps_at_limit = 0;
}

Spent Measurement::advance(int steps) {
  const double before = accepted_ ? 0.0 : allocated_bytes();
  static const double reading = reading_cost();
  const double cpu = cpu_seconds();
  const auto begin = Clock::now();
  const Tally tally = run_steps(*simulation_, steps);
  const double seconds = seconds_since(begin);
  constexpr double kLeast = 1e-9;  // s: nothing takes no time
  const Spent spent{seconds, std::max(kLeast, cpu_seconds() - cpu - reading)};
  if (!accepted_) figures_.memory_bytes += allocated_bytes() - before;
  if (tally.failed_step > 0) {
    throw CellFailure(fmt::format("factorization-failed: the tangent of step {} of {} was refused",
                                  done_ + tally.failed_step, task_.stretch.steps));
  }
  done_ += steps;
  figures_.passes += tally.passes;
  figures_.steps_at_limit += tally.steps_at_limit;
  return spent;
}

void Measurement::accept() {
  accepted_ = true;
  if (!task_.control) judge_end();
  if (task_.phases) profile();
}

void Measurement::prepare() {
  set_up();
  start();
  advance(task_.stretch.steps);
  accept();
}

double Measurement::time_stretch() {
  start();
  return advance(task_.stretch.steps).seconds;
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

void Measurement::require_finite(const char* when) {
  State state;
  simulation_->get_state(state);
  const auto finite = [](double x) { return std::isfinite(x); };
  if (task_.control) return;  // it computes nothing
  if (std::ranges::all_of(state.q, finite) && std::ranges::all_of(state.v, finite) &&
      std::ranges::all_of(state.a, finite) && std::ranges::all_of(state.lambda, finite)) {
    return;
  }
  throw CellFailure(fmt::format("diverged: the state is not finite {}", when));
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
