// Between which penalty factors a scene simulates well with a given step.
#pragma once

#include "describe/structure.hpp"
#include "mbs/model.hpp"
#include "mbs/simulation.hpp"

namespace mbs {

/// An estimate from the start alone; penalty_window.md here says where it is from.
/// On mechanisms that meet singular positions it is right to a factor of about ten, others work
/// below it too. Empty, lower > upper, if the step is too short for the precision; in single
/// precision also if it is too long for the motion.
struct PenaltyWindow {
  double lower = 0.0;         ///< alpha; below it the multipliers do not converge
  double upper = 0.0;         ///< alpha; above it errors grow in proportion
  double stable = 0.0;        ///< alpha; below it a step of one pass makes the slowest mode grow
  double widest = 0.0;        ///< single precision: upper / lower at the step where that is most
  double rate = 0.0;          ///< omega, the fastest rate of turning expected, 1/s
  bool slowest_mode = false;  ///< whether the slowest mode sets `lower`, not singular positions
  bool cancellation = false;  ///< whether rounding sets `upper`, as always in double precision
};

/// For the step and precision of `settings`; mixed precision has double's. The model must have a
/// constraint that is not redundant. `smallest`: smallest_constraint_eigenvalue() at the start.
PenaltyWindow penalty_window(const Model& model, const Structure& structure, double smallest,
                             const StepSettings& settings);

}  // namespace mbs
