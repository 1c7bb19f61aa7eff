// What rounding of the penalty forces does to light parts, and to the forces themselves.
#pragma once

#include <string>

#include "mbs/model.hpp"
#include "mbs/simulation.hpp"

namespace mbs {

/// Rounding of Phi makes forces of the size alpha eps |Phi| Phi_q, which hardly move a heavy part
/// but shake a light one. Estimates how far they drive each point in `steps` steps, as a random
/// walk; says at which point and what to do if that is beyond a tenth of `length` (m), for it was
/// about ten times what rods of 1e-3 to 1e-12 kg below one of 1 kg were off by. Empty if not, and
/// for schemes without penalty forces and for single precision, which is off by more anyway.
std::string rounding_degradation(const Model& model, const StepSettings& settings, long steps,
                                 double length);

/// How much of the largest constraint force or load at `state` rounding of the coordinates may make
/// in the penalty form: alpha |Phi_q|^2 eps max|q| over |Phi_q| |lambda| or |Q|, each the largest.
/// 0 where nothing acts.
double rounding_of_penalty_forces(const Model& model, double penalty, const State& state);

/// Says if that is more than a tenth, and what to do. Empty if not, and for the same settings.
std::string drowned_forces(const Model& model, const StepSettings& settings, const State& state);

}  // namespace mbs
