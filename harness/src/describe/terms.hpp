// Which terms of the equations a scene has.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "scene/scene.hpp"

namespace mbs {

/// A count or true/false for each term: gravity (also of other constant forces), couples, springs
/// (and dampers), torsion_springs, laws (of forces and torques), factors (of laws, of time),
/// stiffness, damping, rods, bodies, dot_constraints, bilinear_constraints, linear_constraints,
/// fixed_points, driven_points, driven_constraints.
nlohmann::json terms_json(const Scene& scene);

/// "gravity (Q), fixed points (2)": the terms that are there, or those that are not.
std::string term_list(const nlohmann::json& terms, bool present);

}  // namespace mbs
