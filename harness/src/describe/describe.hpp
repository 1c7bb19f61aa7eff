// What a scene requires and what it asks of the linear algebra: `mbs describe`.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "mbs/simulation.hpp"
#include "scene/scene.hpp"

namespace mbs {

/// The description for programs, but for what recommended() adds. Step and precision of
/// `settings` are what the penalty window and the warnings are for. Keys:
///
/// - scene, dimension, variables, constraints; free_points, free_vectors: those that own the
///   variables; fixed_points, fixed_vectors, driven_points, driven_vectors: those that the scene
///   names;
/// - jacobian_rank (null if that was too much work), degrees_of_freedom, degrees_of_freedom_from
///   ("n - rank" or "n - m"), redundant_constraints [names], singular_start {rank, constraints} or
///   false, null if unknown;
/// - assembly {position_correction, velocity_correction, point};
/// - terms {name: count or true/false};
/// - mass, jacobian and tangent {nonzeros, fill}, fill as a share of n^2 or m n;
/// - passes {"penalty", "saddle-point"}: of a step, kUnknownPasses until recommended() counts them;
///   "assumed": the forms in which they are not counted;
/// - elimination, see elimination_json(); features {name: number or null}, README.md;
/// - smallest_eigenvalue (m^2/kg) of Phi_q M^-1 Phi_q^T at the start, of those above 0; infinite
///   without constraints, which text has as null;
/// - judged_length (m), what `mbs simulate` judges estimated and local errors by;
/// - drivers_end (s; null if drivers are known for ever or there are none);
/// - penalty_window {step, lower, upper, automatic, lower_from, upper_from} or null;
/// - precision, of `settings`; scheme {take, reason}: "penalty", or "saddle-point" where no penalty
///   factor is expected to do at this step;
/// - warnings [text]: why the automatic penalty factor or the step is likely to be wrong;
/// - artificial_fill {asked, natural, reached, seed} or null;
/// - elements, see elements_json().
nlohmann::json describe_json(const Scene& scene, const StepSettings& settings);

/// The same for people, several lines.
std::string describe_text(const nlohmann::json& description);

/// What the assembly of the start changed: keys position_correction, velocity_correction, point.
nlohmann::json assembly_json(const AssemblyReport& report);
/// The same on one line.
std::string assembly_text(const nlohmann::json& assembly);

}  // namespace mbs
