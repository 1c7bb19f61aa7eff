// What the scene's author named, as JSON for pictures.
#pragma once

#include <nlohmann/json.hpp>

#include "scene/scene.hpp"

namespace mbs {

/// Keys: points [{name, kind, position}] with kind "free", "fixed", "driven", "vector" or "marker",
/// positions at t = 0; rods and springs [{name, between}]; bodies [{name, points, vectors}];
/// torsion_springs [{name, from, to}], each direction a pair of points; outputs [name]. Points are
/// referred to by name. A scene that names neither rods nor bodies has its distances as rods.
nlohmann::json elements_json(const Scene& scene);

}  // namespace mbs
