// The one way to simulations, batches and operations: what a variant does not serve is refused
// here, before anything runs.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "mbs/implementation.hpp"

namespace mbs {

/// All terms with their names, for people: "torsion springs".
const std::vector<std::pair<std::string, Term>>& term_names();

Terms all_terms();

/// The terms of `model`, each with the first item that has it: "spring 'left'".
std::vector<std::pair<Term, std::string>> terms_of(const Model& model);

/// The term of `model` that a variant with `terms` does not serve, and where; empty if none.
std::string why_not_served(const Terms& terms, const Model& model);

/// Which setting a variant that serves `serves` does not offer, for people; empty if none.
std::string why_not_served(const Serves& serves, const StepSettings& settings);

/// The first of the settings, else of the terms, that a variant does not serve; empty if none.
std::string why_not_served(const Serves& serves, const Model& model, const StepSettings& settings);

/// Why no implementation can simulate `model` with `settings`; empty if nothing forbids it.
std::string why_unsuited(const Model& model, const StepSettings& settings);

/// variant.create(). Throws Unsupported with why_unsuited() or why_not_served(), and
/// std::invalid_argument if penalty factor or tolerance is not chosen.
std::unique_ptr<Simulation> create_simulation(const Variant& variant, const Model& model,
                                              const StepSettings& settings);

/// variant.create_batch() of models of one shape; nullptr if the variant offers none. Throws as
/// create_simulation().
std::unique_ptr<BatchSimulation> create_batch(const Variant& variant,
                                              std::span<const Model* const> models,
                                              std::span<const StepSettings> settings);

/// variant.operations(); nullptr if the variant offers none. Throws as create_simulation().
std::unique_ptr<Operations> create_operations(const Variant& variant, const Model& model);

/// The settings beyond the defaults that a variant serves, for people; empty if none.
std::vector<std::string> served_settings(const Serves& serves);

/// The terms that a variant serves, for people; empty if none.
std::vector<std::string> served_terms(const Terms& terms);

}  // namespace mbs
