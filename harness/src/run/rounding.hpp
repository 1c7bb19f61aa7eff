// What rounding of coordinates does to the constraint forces of the penalty form.
#pragma once

#include <string>

#include "mbs/model.hpp"
#include "mbs/simulation.hpp"

namespace mbs {

/// How much of the largest constraint force or load at `state` rounding of the coordinates may make
/// in the penalty form: alpha |Phi_q|^2 eps max|q| over |Phi_q| |lambda| or |Q|, each the largest.
/// 0 where nothing acts.
double rounding_of_penalty_forces(const Model& model, double penalty, const State& state);

/// Says if that is more than a tenth, and what to do. Empty if not, for schemes without penalty
/// forces, and for single precision, which is off by more anyway.
std::string drowned_forces(const Model& model, const StepSettings& settings, const State& state);

}  // namespace mbs
