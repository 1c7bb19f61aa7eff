// Runs one simulation from start to end and reports a typed outcome.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "registry/registry.hpp"
#include "run/judge.hpp"
#include "run/step_times.hpp"

namespace mbs {

enum class RunStatus {
  ok,             ///< the whole duration was simulated within AccurateBounds
  plausible,      ///< the same, but nothing tells the position error itself: see Judge
  degraded,       ///< ... within RunBounds; the reason says what is beyond AccurateBounds
  not_converged,  ///< more steps than RunBounds allows ended at the pass limit
  diverged,       ///< the solution was lost: not finite, beyond RunBounds, or the step threw
  wrong_branch,   ///< it went on as another assembly of the mechanism, which the constraints allow
  unsupported,    ///< the implementation cannot simulate this scene
};

/// How results name a RunStatus, and what it means to users, on one line.
struct Outcome {
  RunStatus status;
  std::string name, meaning;
};

/// Of every RunStatus, the best first.
const std::vector<Outcome>& outcomes();

/// Whether the whole duration was simulated, with every step converged: ok, plausible or degraded.
bool is_finished(RunStatus status);

/// Its name among outcomes().
std::string to_string(RunStatus status);

struct RunSettings {
  StepSettings step;
  double duration = 20.0;  ///< s; rounded to a whole number of steps
  /// Steps between two judgements; none: judge_interval(). The last step is judged too. Where one
  /// finds the solution lost, the steps since the one before are done again to find the first that
  /// was.
  std::optional<int> judge_every = {};
  /// What half the step is to be simulated with, beside the run, to estimate its error:
  /// HalfStepRun.
  std::optional<StepSettings> half_step = {};
  bool scale_equations = false;            ///< simulate with ScaledEquations
  std::optional<double> deadline_us = {};  ///< steps that take longer are counted
  /// Times the motion is simulated. The repeats are only timed: what interrupts a step of one run
  /// hardly interrupts the same step of another. Steps that are so short that reading the clock
  /// counts are timed in blocks, whose steps then share one time.
  int repeats = 1;
};

struct RunSummary {
  RunStatus status = RunStatus::ok;
  std::string reason;  ///< one line, empty if ok
  /// The parts of `reason` of which half the step tells nothing: why the run may be on another
  /// branch; which of the forces and accelerations that the scene asks for are off.
  std::string branch_doubt, forces_lost;
  std::optional<double> failed_at;  ///< s, if not ok and it has an instant; degraded: by when
  long steps = 0;                   ///< done
  long passes = 0;
  long factorizations = 0;
  long steps_at_limit = 0;
  double setup_us = 0.0;  ///< the factory and the first set_state()
  double judge_us = 0.0;  ///< mean a step: what judging and copying states out for it take
  StepTimes step_us;      ///< of the first run
  std::optional<StepTimes> least_us;              ///< each step's least over all runs, with repeats
  std::optional<double> position_error_max;       ///< m
  std::optional<double> position_error_estimate;  ///< m, with RunSettings::half_step
  /// Sum of what single steps leave, m: what the position error comes to if nothing damps or
  /// multiplies it, such as a lag, which neither energy nor constraints show. None where the exact
  /// motion is known, or drivers leave no freedom.
  std::optional<double> local_error_sum;
  std::optional<double> energy_drift_max;  ///< none if the model is not conservative
  std::optional<double> imbalance_max;     ///< Judge::imbalance_max()
  double constraint_violation_max = 0.0;
};

/// Called after each step, and once before the first with step 0, outside the clocks.
using Observer = std::function<void(long step, double t, const State& state)>;
/// Called after each step with its time, outside the clocks: for whom no state is copied out.
using Follower = std::function<void(double t)>;

/// Number of steps that `duration` takes. Throws UsageError if settings are out of range.
long count_steps(const RunSettings& settings);

/// RunSettings::judge_every, or, if it has none, 64 steps, up to 128 in a run that is judged 128
/// times all the same, or 256 where the exact motion judges alone, which keeps judging a small
/// share of even the fastest steps, but fewer where the run would not be judged 32 times. 1 or
/// more.
long judge_interval(const Scene& scene, const RunSettings& settings);

/// Throws UsageError, like run(), if settings are out of range or do not fit the scene's drivers:
/// beyond a table, out of a range, too coarse steps.
void require_duration(const Scene& scene, const RunSettings& settings);

/// Simulates; stops where the judge refuses a state. Never throws for a numeric failure;
/// throws UsageError if settings are out of range or the duration is beyond the model's drivers.
RunSummary run(const Scene& scene, const Variant& variant, const RunSettings& settings,
               const Observer& observer = {}, const Follower& follower = {});

}  // namespace mbs
