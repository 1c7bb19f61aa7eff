// The description as JSON.
#include "describe/describe.hpp"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <optional>
#include <vector>

#include "describe/elements.hpp"
#include "describe/elimination.hpp"
#include "describe/features.hpp"
#include "describe/passes.hpp"
#include "describe/penalty_window.hpp"
#include "describe/structure.hpp"
#include "describe/terms.hpp"
#include "describe/warnings.hpp"
#include "model_math/kinematics.hpp"
#include "registry/setting_names.hpp"
#include "run/driver_end.hpp"
#include "run/initial_state.hpp"
#include "run/judge.hpp"
#include "run/settings.hpp"
#include "scene/row_names.hpp"

namespace mbs {
namespace {

using nlohmann::json;

json matrix(long nonzeros, double positions) {
  const double fill = positions > 0.0 ? static_cast<double>(nonzeros) / positions : 0.0;
  return {{"nonzeros", nonzeros}, {"fill", fill}};
}

json names_of(const Model& model, const std::vector<int>& rows) {
  json names = json::array();
  for (const int row : rows) names.push_back(row_name(model, row));
  return names;
}

/// Those that the scene names: helpers of the lowering are no answer to what it asks for.
void add_points(json& result, const Scene& scene) {
  const auto points = scene.model.points();
  std::vector<char> counts(points.size(), true), driven(points.size(), false);
  for (const int index : scene.elements.helpers) {
    if (static_cast<std::size_t>(index) < points.size())
      counts[static_cast<std::size_t>(index)] = false;
  }
  for (const DrivenPoint& point : scene.model.driven_points()) {
    driven[static_cast<std::size_t>(point.point)] = true;
  }
  std::map<std::string, int> found{{"free_points", 0},   {"free_vectors", 0},
                                   {"fixed_points", 0},  {"fixed_vectors", 0},
                                   {"driven_points", 0}, {"driven_vectors", 0}};
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!counts[i] && points[i].is_fixed()) continue;
    const std::string how = driven[i] ? "driven" : points[i].is_fixed() ? "fixed" : "free";
    ++found[how + (points[i].is_vector ? "_vectors" : "_points")];
  }
  for (const auto& [key, count] : found) result[key] = count;
}

void add_structure(json& result, const Model& model, const Structure& structure) {
  result["jacobian_rank"] = nullptr;
  if (structure.rank) result["jacobian_rank"] = *structure.rank;
  result["degrees_of_freedom"] = model.variables() - structure.rank.value_or(model.constraints());
  result["degrees_of_freedom_from"] = structure.rank ? "n - rank" : "n - m";
  result["redundant_constraints"] = names_of(model, structure.redundant);
  result["singular_start"] = nullptr;
  if (!structure.singular) return;
  result["singular_start"] = false;
  if (!*structure.singular) return;
  result["singular_start"] = {{"rank", *structure.rank_at_start},
                              {"constraints", names_of(model, structure.singular_rows)}};
}

json penalty_json(const PenaltyWindow& window, const StepSettings& settings) {
  return {{"step", settings.step},
          {"lower", window.lower},
          {"upper", window.upper},
          {"automatic", settings.penalty},
          {"lower_from", window.slowest_mode ? "slowest mode" : "singular positions"},
          {"upper_from", window.cancellation ? "cancellation" : "nonlinearity"}};
}

json scheme_json(Scheme scheme, const std::string& reason) {
  return {{"take", name_of(scheme)}, {"reason", reason}};
}

/// The window, and what is likely to go wrong with the automatic factor and this step.
void add_settings(json& result, const Model& model, const Structure& structure, double smallest,
                  StepSettings settings) {
  result["precision"] = name_of(settings.precision);
  result["penalty_window"] = nullptr;
  result["scheme"] = scheme_json(Scheme::penalty, "penalty form, as there are no constraints");
  result["warnings"] = json::array();
  std::vector<std::string> warnings{period_warning(model, settings.step)};
  if (model.constraints() > 0) {
    settings.penalty = automatic_penalty(model, settings, smallest);
    const PenaltyWindow window = penalty_window(model, structure, smallest, settings);
    result["penalty_window"] = penalty_json(window, settings);
    warnings.push_back(penalty_warning(window, settings, PenaltyFrom::rule));
    const bool is_open = warnings.back().empty();
    result["scheme"] = scheme_json(
        is_open ? Scheme::penalty : Scheme::saddle_point,
        fmt::format("{}, as {} at step {:g} s", is_open ? "penalty form" : "saddle-point form",
                    is_open ? "the automatic penalty factor is stable"
                            : "no penalty factor is expected to do",
                    settings.step));
  }
  for (const std::string& warning : warnings) {
    if (!warning.empty()) result["warnings"].push_back(warning);
  }
}

json finite_or_null(double value) { return std::isfinite(value) ? json(value) : json(nullptr); }

json fill_json(const std::optional<Fill>& fill) {
  if (!fill) return nullptr;
  return {{"asked", fill->asked},
          {"natural", fill->natural},
          {"reached", fill->reached},
          {"seed", fill->seed}};
}

}  // namespace

json assembly_json(const AssemblyReport& report) {
  return {{"position_correction", report.position_correction},
          {"velocity_correction", report.velocity_correction},
          {"point", report.point}};
}

json describe_json(const Scene& scene, const StepSettings& settings) {
  const Model& model = scene.model;
  const double n = model.variables();
  const double m = model.constraints();
  const Structure structure = find_structure(model);
  const double smallest = smallest_constraint_eigenvalue(model, model.initial_position());
  const auto jacobian_entries = jacobian(model, 0.0, model.initial_position()).size();
  json result = {
      {"scene", scene.name},
      {"dimension", model.dimension()},
      {"variables", model.variables()},
      {"constraints", model.constraints()},
      {"assembly", assembly_json(scene.assembly)},
      {"terms", terms_json(scene)},
      {"mass", matrix(2 * static_cast<long>(model.mass().size()) - model.variables(), n * n)},
      {"jacobian", matrix(static_cast<long>(jacobian_entries), m * n)},
      {"tangent", matrix(tangent_nonzeros(model), n * n)},
      {"judged_length", judged_length(model)},
      {"smallest_eigenvalue", smallest},
      {"drivers_end", finite_or_null(driver_end(model))},
      {"artificial_fill", fill_json(scene.fill)},
      {"elements", elements_json(scene)}};
  result["elimination"] = elimination_json(tangent_pattern(model), saddle_point_pattern(model),
                                           owned_coordinates(model));
  add_points(result, scene);
  add_structure(result, model, structure);
  add_settings(result, model, structure, smallest, settings);
  result["passes"] = {{"penalty", kUnknownPasses},
                      {"saddle-point", kUnknownPasses},
                      {"assumed", {"penalty", "saddle-point"}}};
  result["features"] = features_json(result);
  return result;
}

}  // namespace mbs
