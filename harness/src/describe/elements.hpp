// What the scene's author named, as JSON for pictures.
#pragma once

#include <nlohmann/json.hpp>

#include "scene/scene.hpp"

namespace mbs {

/// Keys: points [{name, kind, helper, position}] with kind "free", "fixed", "driven", "vector" or
/// "marker", helper true where the scene does not name it, positions at t = 0; rods, distances
/// (constraints), springs and force_laws [{name, between}]; bodies [{name, points, vectors}];
/// torsion_springs and torque_laws [{name, from, to}], each direction a pair of points; outputs
/// [name]. Points are referred to by name.
nlohmann::json elements_json(const Scene& scene);

}  // namespace mbs
