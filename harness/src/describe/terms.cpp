// Counts what the model holds.
#include "describe/terms.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>
#include <vector>

namespace mbs {
namespace {

using nlohmann::json;

constexpr std::pair<const char*, const char*> kNames[] = {
    {"gravity", "gravity or constant forces (Q)"},
    {"couples", "constant torques"},
    {"springs", "springs and dampers"},
    {"torsion_springs", "torsion springs"},
    {"laws", "laws of forces and torques"},
    {"factors", "factors of time"},
    {"stiffness", "stiffness (K)"},
    {"damping", "damping (C)"},
    {"rods", "rods"},
    {"bodies", "bodies"},
    {"dot_constraints", "quadratic constraints"},
    {"bilinear_constraints", "bilinear constraints"},
    {"linear_constraints", "linear constraints"},
    {"fixed_points", "fixed points"},
    {"driven_points", "driven points"},
    {"driven_constraints", "drivers (Phi_t)"}};

}  // namespace

json terms_json(const Scene& scene) {
  const Model& model = scene.model;
  const auto force = model.force();
  const auto stiff = [](const auto& spring) { return spring.stiffness != 0.0; };
  const auto damped = [](const auto& spring) { return spring.damping != 0.0; };
  std::vector<const Law*> laws;
  for (const ForceLaw& law : model.force_laws()) laws.push_back(&law.law);
  for (const TorqueLaw& law : model.torque_laws()) laws.push_back(&law.law);
  const auto factors =
      std::ranges::count_if(laws, [](const Law* law) { return !law->factor.is_constant(); });
  const auto held = [](const Law* law) { return !law->by_position.is_zero(); };
  const auto rated = [](const Law* law) { return !law->by_rate.is_zero(); };
  const auto fixed =
      std::ranges::count_if(model.points(), [](const Point& p) { return p.is_fixed(); });
  const auto driven = static_cast<std::ptrdiff_t>(model.driven_points().size());
  return {{"gravity", std::ranges::any_of(force, [](double x) { return x != 0.0; })},
          {"couples", model.couples().size()},
          {"springs", model.springs().size()},
          {"torsion_springs", model.torsion_springs().size()},
          {"laws", laws.size()},
          {"factors", factors},
          {"stiffness", std::ranges::any_of(model.springs(), stiff) ||
                            std::ranges::any_of(model.torsion_springs(), stiff) ||
                            std::ranges::any_of(laws, held)},
          {"damping", std::ranges::any_of(model.springs(), damped) ||
                          std::ranges::any_of(model.torsion_springs(), damped) ||
                          std::ranges::any_of(laws, rated)},
          {"rods", scene.elements.rods.size()},
          {"bodies", scene.elements.bodies.size()},
          {"dot_constraints", model.dot_constraints().size()},
          {"bilinear_constraints", model.bilinear_constraints().size()},
          {"linear_constraints", model.linear_constraints().size()},
          {"fixed_points", fixed - driven},
          {"driven_points", driven},
          {"driven_constraints", driven > 0 || !model.driven_values().empty()}};
}

std::string term_list(const json& terms, bool present) {
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

}  // namespace mbs
