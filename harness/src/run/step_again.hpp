// The step that is judged, done once more by another simulation that does it better.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "mbs/model.hpp"
#include "mbs/simulation.hpp"

namespace mbs {

/// Velocities that are too high, n, m/s: when the step ended, and what is still there a step later.
/// A stiff damper takes an error away at once, or turns it round.
struct SpeedError {
  std::vector<double> now, later;
};

/// What passes that ended early, kept tangents and projections by an older tangent leave in a step
/// of a trapezoidal form: the difference to the same step with a tangent of every pass, the
/// tolerance of half the step and, so that it costs no more than a few steps, two passes more than
/// the others had.
class StepAgain {
 public:
  using Create = std::function<std::unique_ptr<Simulation>(const StepSettings&)>;

  /// `create` makes simulations like the judged one, which has `settings` and does about `passes` a
  /// step.
  StepAgain(const Create& create, const Model& model, const StepSettings& settings, double passes);

  /// Of the velocity that the next step begins with, v + dt/2 a; `after` is one step after
  /// `before`. Not finite where the step could not be done again. What is below `negligible` (m/s)
  /// everywhere is not followed and taken to stay.
  const SpeedError& error(const State& before, const State& after, double negligible);

 private:
  void advance(const State& from, State& to);
  /// Returns the largest.
  double subtract(const State& x, const State& y, std::vector<double>& faster) const;

  double step_;  // s
  std::unique_ptr<Simulation> simulation_;
  bool is_done_ = true;
  State again_, later_, again_later_;
  SpeedError error_;
};

/// The largest velocity, m/s, that a step of a trapezoidal form can leave whose passes ended at the
/// tolerance, each with a tangent of its own. Infinite for other tangents.
double most_left(const StepSettings& settings);

}  // namespace mbs
