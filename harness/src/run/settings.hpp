// Settings that the harness chooses from the model.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mbs/simulation.hpp"

namespace mbs {

/// The penalty factor `auto` for the step, scheme, tangent and precision of `settings`
/// (automatic_settings.md here); 1 without constraints. `smallest`: the smallest eigenvalue above 0
/// of Phi_q M^-1 Phi_q^T at the start (m^2/kg), where it is known.
double automatic_penalty(const Model& model, const StepSettings& settings,
                         std::optional<double> smallest = std::nullopt);

/// Diagonal of Phi_q M^-1 Phi_q^T with the diagonal of M, at the start (m), m^2/kg.
std::vector<double> constraint_diagonal(const Model& model);

/// s_mean of the above, m^2/kg; not a number for a model without constraints.
double mean_constraint_eigenvalue(const Model& model);

/// s_row of the above, m^2/kg: the heaviest that a constraint moves, where light unit vectors can
/// make the mean a hundred times as much. Infinite for a model without constraints.
double least_constraint_diagonal(const Model& model);

/// u of the precision that a step is computed in; of mixed precision that of double.
double unit_roundoff(Precision precision);

/// The lesser of max|q| and the scene's extent, m: constraints see differences of points, so that
/// this is what their rounding is relative to.
double rounding_length(const Model& model);

/// The tolerance `auto` (m) for the step, scheme, penalty factor, tangent and precision of
/// `settings`: automatic_settings.md here.
double automatic_tolerance(const Model& model, const StepSettings& settings);

/// `settings` with what is 0 of the two chosen. Throws UsageError where no number suits.
StepSettings chosen(const Model& model, StepSettings settings = {},
                    std::optional<double> smallest = std::nullopt);

/// 0 for "auto", else the number above 0 that `text`, the value of `option`, is. `what`: " (m)".
/// Throws UsageError.
double parse_automatic(const char* option, const std::string& text, const char* what = "");

}  // namespace mbs
