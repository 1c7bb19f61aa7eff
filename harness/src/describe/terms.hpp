// Which terms of the equations a scene has.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "scene/scene.hpp"

namespace mbs {

/// A count or true/false for each term: gravity, fixed_points, driven_points, rods, bodies,
/// springs, dampers, torsion_springs, couples, dot_constraints, bilinear_constraints,
/// linear_constraints, stiffness, damping, driven_constraints.
nlohmann::json terms_json(const Scene& scene);

/// "gravity (Q), fixed points (2)": the terms that are there, or those that are not.
std::string term_list(const nlohmann::json& terms, bool present);

}  // namespace mbs
