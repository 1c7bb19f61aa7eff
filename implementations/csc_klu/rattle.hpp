// RATTLE of second, fourth and sixth order: stages of one saddle-point factorization each.
#pragma once

#include <memory>

#include "mbs/simulation.hpp"
#include "solver.hpp"

namespace mbs::csc_klu {

/// A simulation by Scheme::rattle, rattle4 or rattle6 of a `model` without drivers and dampers,
/// which outlives it. Instantiated in rattle.cpp for every solver.
template <TangentSolver Solver>
[[nodiscard]] std::unique_ptr<Simulation> create_rattle(const Model& model,
                                                        const StepSettings& settings);

}  // namespace mbs::csc_klu
