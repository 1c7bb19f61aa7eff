// What rounding of coordinates does to the constraint forces of the penalty form.
#pragma once

#include <limits>
#include <string>

#include "mbs/model.hpp"
#include "mbs/simulation.hpp"

namespace mbs {

/// How much of the largest constraint force or load at `state` rounding of the coordinates may make
/// in the penalty form: alpha |Phi_q|^2 epsilon max|q| over |Phi_q| |lambda| or |Q|, each the
/// largest. 0 where nothing acts. `solved`: the same model, perhaps with scaled constraints, which
/// the penalty factor is of; lambda is that of `model`.
double rounding_of_penalty_forces(const Model& model, const Model& solved, double penalty,
                                  const State& state,
                                  double epsilon = std::numeric_limits<double>::epsilon());

/// Says if that is more than a tenth, in single precision with that of its coordinates, and what to
/// do. Empty if not, and for schemes without penalty forces.
std::string drowned_forces(const Model& model, const Model& solved, const StepSettings& settings,
                           const State& state);

}  // namespace mbs
