// All lanes but one, which must not disturb the others.
#include "check/batch_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "check/lock_step.hpp"
#include "check/processor_time.hpp"
#include "check/varied_lanes.hpp"
#include "model_math/extent.hpp"
#include "printable.hpp"
#include "registry/factory.hpp"

namespace mbs {
namespace {

constexpr int kRetired = 0, kSpoiled = 2;  // lanes
constexpr double kMassApart = 0.04;        // lane to lane
constexpr std::size_t kSteps = 200, kRetiredAt = 10;

/// A batch at its start; one lane is so fast that its numbers overflow.
std::unique_ptr<BatchSimulation> start_batch(const Variant& variant, const VariedLanes& lanes) {
  auto batch = create_batch(variant, lanes.pointers, lanes.settings);
  for (int k = 0; k < lanes.count(); ++k) {
    State state = lanes.starts[static_cast<std::size_t>(k)];
    if (k == kSpoiled) std::ranges::fill(state.v, 1e300);
    batch->set_state(k, state);
  }
  return batch;
}

void add_lock_steps(LockStep& check, const Variant& variant, const VariedLanes& lanes) {
  const auto batch = start_batch(variant, lanes);
  std::vector<StepOutcome> outcomes(lanes.models.size());
  batch->step(outcomes);
  State state;
  for (int k = 0; k < lanes.count(); ++k) {
    if (k == kSpoiled) continue;
    const auto i = static_cast<std::size_t>(k);
    ReferenceSimulation reference(*lanes.models[i], lanes.settings[i]);
    Probe probe{lanes.starts[i].t, lanes.starts[i], {}, {}, 0.0};
    take_probe(reference, *lanes.models[i], probe);
    batch->get_state(k, state);
    check.add(probe, lanes.settings[i], outcomes[i], state,
              fmt::format("lane {} of {}: ", k + 1, lanes.count()));
  }
}

/// What running batches beside simulations alone has found so far.
struct Running {
  FreeRunningTolerance allowed;
  std::size_t most_steps;  // of a batch
  Check check{"batch-running", 0.0, allowed.q, true, ""};
  long passes = 0, expected_passes = 0;
  long steps = 0;
};

/// Compares lane k after step `step`, which `outcome` is of; false: it differs.
bool compare(Running& running, const VariedLanes& lanes, int k, std::size_t step,
             const StepOutcome& outcome, const State& state, const State& expected) {
  const std::string lane = fmt::format("lane {} of {}", k + 1, lanes.count());
  if (outcome.status == StepStatus::factorization_failed) {
    running.check.passed = false;
    running.check.detail = fmt::format("{}: factorization failed first at step {}", lane, step);
    return false;
  }
  const double difference = largest_difference(state.q, expected.q);
  running.check.value =
      std::isnan(difference) ? difference : std::max(*running.check.value, difference);
  if (difference <= *running.check.tolerance) return true;
  running.check.passed = false;
  running.check.detail =
      fmt::format("{}: q differs by {:.1e} m first at step {}", lane, difference, step);
  return false;
}

void run_beside(Running& running, const Variant& variant, const VariedLanes& lanes, double end) {
  const auto batch = start_batch(variant, lanes);
  std::vector<std::unique_ptr<Simulation>> alone;
  for (std::size_t i = 0; i < lanes.models.size(); ++i) {
    alone.push_back(create_simulation(variant, *lanes.models[i], lanes.settings[i]));
    alone.back()->set_state(lanes.starts[i]);
  }
  std::vector<StepOutcome> outcomes(lanes.models.size());
  State state, expected;
  for (std::size_t step = 1; step <= running.most_steps && processor_seconds() < end; ++step) {
    if (step == kRetiredAt) batch->retire(kRetired);
    batch->step(outcomes);
    for (int k = 0; k < lanes.count(); ++k) {
      if (k == kSpoiled || batch->is_retired(k)) continue;
      const auto i = static_cast<std::size_t>(k);
      const StepOutcome outcome = alone[i]->step();
      constexpr auto kLost = StepStatus::factorization_failed;
      if (outcomes[i].status == kLost && outcome.status == kLost) {
        batch->retire(k);  // its motion is lost either way
        continue;
      }
      running.passes += outcomes[i].passes;
      running.expected_passes += outcome.passes;
      batch->get_state(k, state);
      alone[i]->get_state(expected);
      if (!compare(running, lanes, k, step, outcomes[i], state, expected)) return;
    }
    ++running.steps;
  }
}

Check conclude(Running running) {
  if (!*running.check.passed) return running.check;
  if (running.steps == 0) {
    return {"batch-running", {}, {}, {}, "there was no time for a step: a longer --time-limit"};
  }
  const double differ = std::abs(static_cast<double>(running.passes - running.expected_passes));
  const double allowed =
      std::floor(running.allowed.passes * static_cast<double>(running.expected_passes));
  running.check.detail = fmt::format("m; {} steps of 3 and 11 lanes", running.steps);
  if (differ > allowed) {
    running.check = {
        "batch-running", differ, allowed, false,
        fmt::format("{} instead of {} passes", running.passes, running.expected_passes)};
  }
  return running.check;
}

}  // namespace

std::vector<Check> batch_checks(const Variant& variant, const Model& model,
                                const StepSettings& settings, const ReferenceRun& reference,
                                double seconds) {
  LockStep lock_step("batch");
  Running running{free_running_tolerance(reference.probes.back(), settings, extent(model.points())),
                  std::min(kSteps, reference.positions.size())};
  const double begin = processor_seconds();
  int part = 0;
  try {
    for (const int count : {3, 11}) {
      const VariedLanes lanes =
          vary_lanes(count, kMassApart, model, settings, reference.stretch.initial);
      add_lock_steps(lock_step, variant, lanes);
      run_beside(running, variant, lanes, begin + seconds * ++part / 2);
      if (!*running.check.passed) break;
    }
  } catch (const Unsupported& reason) {
    const std::string why = printable(reason.what(), 1000);
    return {{"batch", {}, {}, {}, why}, {"batch-running", {}, {}, {}, why}};
  }
  if (settings.precision != Precision::double_precision) {
    running.passes = running.expected_passes;  // rounding decides on them
  }
  return {lock_step.check(), conclude(running)};
}

}  // namespace mbs
