// The trapezoidal step with all settings: saddle-point form, kept factors, refined projections.
#pragma once

#include <memory>

#include "mbs/simulation.hpp"
#include "shallow_order.hpp"
#include "solver.hpp"

namespace mbs::csc_klu {

/// A simulation in penalty or saddle-point form with any settings of the multipliers, the tangent
/// and the projections; `model` outlives it. Instantiated in trapezoidal.cpp for every solver.
template <TangentSolver Solver>
[[nodiscard]] std::unique_ptr<Simulation> create_trapezoidal(const Model& model,
                                                             const StepSettings& settings,
                                                             Order order = Order::shallow);

}  // namespace mbs::csc_klu
