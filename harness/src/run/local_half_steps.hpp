// What one step leaves, by two steps of half its length from the same state.
#pragma once

#include <memory>
#include <vector>

#include "run/step_again.hpp"

namespace mbs {

/// For schemes whose local error has no formula as short as the trapezoidal rule's: that of order p
/// leaves 2^p / (2^p - 1) times the difference to two half steps.
class LocalHalfSteps {
 public:
  /// `create` makes simulations like the judged one, which has `settings`.
  LocalHalfSteps(const StepAgain::Create& create, const StepSettings& settings);

  /// What the step from `before` to `after` left of q, n, m. Not finite where the half steps could
  /// not be done.
  const std::vector<double>& error(const State& before, const State& after);

 private:
  std::unique_ptr<Simulation> simulation_;
  State state_;
  double factor_;
  std::vector<double> error_;
};

}  // namespace mbs
