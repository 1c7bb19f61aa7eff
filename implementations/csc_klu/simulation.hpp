// The step of paper/README.md over sparse storage, and the choice of a scheme.
#pragma once

#include <memory>

#include "mbs/simulation.hpp"
#include "shallow_order.hpp"
#include "solver.hpp"

namespace mbs::csc_klu {

/// Sets a simulation up, of the class that `settings` ask for; `model` outlives it. Instantiated in
/// simulation.cpp for every solver.
template <TangentSolver Solver>
[[nodiscard]] std::unique_ptr<Simulation> create_simulation(const Model& model,
                                                            const StepSettings& settings);

/// `refactor` in either form of "The step" with no setting of its own, in another order.
[[nodiscard]] std::unique_ptr<Simulation> create_ordered(const Model& model,
                                                         const StepSettings& settings, Order order);

extern template std::unique_ptr<Simulation> create_simulation<Refactorization>(const Model&,
                                                                               const StepSettings&);
extern template std::unique_ptr<Simulation> create_simulation<Factorization>(const Model&,
                                                                             const StepSettings&);
extern template std::unique_ptr<Simulation> create_simulation<GuardedRefactorization>(
    const Model&, const StepSettings&);

}  // namespace mbs::csc_klu
