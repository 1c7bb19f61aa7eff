// One description, as JSON; the text is printed from it.
#include "scene/describe.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <vector>

#include "model_math/jacobian_rank.hpp"
#include "model_math/kinematics.hpp"

namespace mbs {
namespace {

using nlohmann::json;

json matrix(long nonzeros, double positions) {
  const double fill = positions > 0.0 ? static_cast<double>(nonzeros) / positions : 0.0;
  return {{"nonzeros", nonzeros}, {"fill", fill}};
}

json terms(const Model& model, std::ptrdiff_t fixed_points) {
  const auto force = model.force();
  const bool has_force = std::any_of(force.begin(), force.end(), [](double x) { return x != 0.0; });
  return {{"gravity", has_force},
          {"dot_constraints", model.dot_constraints().size()},
          {"linear_constraints", model.linear_constraints().size()},
          {"fixed_points", fixed_points},
          {"damping", false},
          {"stiffness", false},
          {"driven_constraints", false}};
}

std::string matrix_line(const char* label, const json& matrix, const std::string& of) {
  return fmt::format("{:<22}{} non-zeros, {:.4g} % of {}\n", label, matrix["nonzeros"].get<long>(),
                     100.0 * matrix["fill"].get<double>(), of);
}

/// "gravity (Q), fixed points (2)": the terms that are there, or those that are not.
std::string term_list(const json& terms, bool present) {
  static constexpr std::pair<const char*, const char*> kNames[] = {
      {"gravity", "gravity (Q)"},
      {"dot_constraints", "quadratic constraints"},
      {"linear_constraints", "linear constraints"},
      {"fixed_points", "fixed points"},
      {"damping", "damping (C)"},
      {"stiffness", "stiffness (K)"},
      {"driven_constraints", "driven (time-dependent) constraints"}};
  std::vector<std::string> names;
  for (const auto& [key, name] : kNames) {
    const json& value = terms[key];
    const long count =
        value.is_boolean() ? static_cast<long>(value.get<bool>()) : value.get<long>();
    if ((count != 0) != present) continue;
    names.push_back(value.is_boolean() || !present ? name : fmt::format("{} ({})", name, count));
  }
  return names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "));
}

}  // namespace

json describe_json(const Scene& scene) {
  const Model& model = scene.model;
  const double n = model.variables();
  const double m = model.constraints();
  const auto points = model.points();
  const auto fixed_points =
      std::count_if(points.begin(), points.end(), [](const Point& p) { return p.is_fixed(); });
  const auto rank = jacobian_rank(model, model.initial_position());
  const auto jacobian_entries = jacobian(model, model.initial_position()).size();
  json result = {
      {"scene", scene.name},
      {"dimension", model.dimension()},
      {"variables", model.variables()},
      {"constraints", model.constraints()},
      {"free_points", static_cast<std::ptrdiff_t>(points.size()) - fixed_points},
      {"fixed_points", fixed_points},
      {"jacobian_rank", nullptr},
      {"degrees_of_freedom", model.variables() - rank.value_or(model.constraints())},
      {"degrees_of_freedom_from", rank ? "n - rank" : "n - m"},
      {"terms", terms(model, fixed_points)},
      {"mass", matrix(2 * static_cast<long>(model.mass().size()) - model.variables(), n * n)},
      {"jacobian", matrix(static_cast<long>(jacobian_entries), m * n)},
      {"tangent", matrix(tangent_nonzeros(model), n * n)},
      {"artificial_fill", nullptr}};
  if (rank) result["jacobian_rank"] = *rank;
  if (scene.fill) {
    result["artificial_fill"] = {{"asked", scene.fill->asked},
                                 {"natural", scene.fill->natural},
                                 {"reached", scene.fill->reached},
                                 {"seed", scene.fill->seed}};
  }
  return result;
}

std::string describe_text(const Scene& scene) {
  const json d = describe_json(scene);
  const bool has_rank = !d["jacobian_rank"].is_null();
  std::string text = fmt::format("{:<22}{}\n", "scene", scene.name);
  text += fmt::format("{:<22}{} ({} free and {} fixed point(s) in {} dimensions)\n",
                      "coordinates n", d["variables"].get<int>(), d["free_points"].get<int>(),
                      d["fixed_points"].get<int>(), d["dimension"].get<int>());
  text += fmt::format("{:<22}{}\n", "constraints m", d["constraints"].get<int>());
  text += fmt::format(
      "{:<22}{} ({})\n", "degrees of freedom", d["degrees_of_freedom"].get<int>(),
      has_rank
          ? fmt::format("n - rank of the Jacobian, {}, at the start", d["jacobian_rank"].get<int>())
          : fmt::format("n - m; the rank is computed up to n = {}", kDenseRankLimit));
  text += fmt::format("{:<22}{}\n", "terms present", term_list(d["terms"], true));
  text += fmt::format("{:<22}{}\n", "terms absent", term_list(d["terms"], false));
  text += matrix_line("mass matrix M", d["mass"], "n^2");
  text += matrix_line("Jacobian", d["jacobian"], "m n");
  text += matrix_line("tangent", d["tangent"], "n^2");
  if (const auto& fill = scene.fill) {
    text += fmt::format("{:<22}asked {:.4g} %, natural {:.4g} %, reached {:.4g} %, seed {}\n",
                        "artificial fill", 100.0 * fill->asked, 100.0 * fill->natural,
                        100.0 * fill->reached, fill->seed);
  }
  return text;
}

}  // namespace mbs
