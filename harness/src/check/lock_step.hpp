// One step from the same state as the reference, and what it may differ by.
#pragma once

#include <string>
#include <vector>

#include "check/reference_run.hpp"
#include "check/verdict.hpp"

namespace mbs {

/// max |x - y|; NaN if either holds one, or if the sizes differ.
double largest_difference(const std::vector<double>& x, const std::vector<double>& y);

/// Tolerances of a lock-step comparison; README.md here has their derivation.
struct LockStepTolerance {
  double q, v, a, lambda;
};
LockStepTolerance lock_step_tolerance(const Probe& probe, const StepSettings& settings);

/// Above this share of the scene's extent a difference of q judges nothing.
double most_allowed(const StepSettings& settings);

/// What a free-running motion may differ by.
struct FreeRunningTolerance {
  double q;          ///< m, after every step
  double passes;     ///< share of all of them
  bool multipliers;  ///< whether they can be judged
};
/// In double precision q is far above what rounding grows to and far below the method's own error,
/// of about 1e-6 m and more in a scene of 1 m; `extent` (m) is the scene's. Where rounding may move
/// q by more than a tenth of that in one step, it also decides on many a pass, and one pass more
/// changes lambda by as much as it moves. Single precision has no solution to agree on beyond its
/// own digits: here it must only follow the same motion.
FreeRunningTolerance free_running_tolerance(const Probe& probe, const StepSettings& settings,
                                            double extent);

/// Gathers comparisons into one check: the worst difference in units of its tolerance.
class LockStep {
 public:
  /// `name` is the check's.
  explicit LockStep(std::string name) : name_(std::move(name)) {}
  /// `state` is what a step from `probe.before` gave; `whose` is for messages: "lane 2: ".
  void add(const Probe& probe, const StepSettings& settings, const StepOutcome& outcome,
           const State& state, const std::string& whose = "");
  [[nodiscard]] Check check() const;

 private:
  std::string name_;
  bool failed_ = false;  // a factorization, or a NaN: what comes later does not matter
  double worst_ = 0.0;
  std::string detail_ = "no difference";
};

}  // namespace mbs
