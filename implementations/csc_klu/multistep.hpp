// The symmetric multistep method of sixth order: one saddle-point factorization a step.
#pragma once

#include <memory>

#include "mbs/simulation.hpp"
#include "solver.hpp"

namespace mbs::csc_klu {

/// A simulation by Scheme::multistep6 of a `model` without drivers and dampers, which outlives it.
/// Instantiated in multistep.cpp for every solver.
template <TangentSolver Solver>
[[nodiscard]] std::unique_ptr<Simulation> create_multistep(const Model& model,
                                                           const StepSettings& settings);

}  // namespace mbs::csc_klu
