// What a scene asks of the linear algebra: `mbs describe`.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "scene/scene.hpp"

namespace mbs {

/// Sizes, degrees of freedom, terms present and absent, non-zeros and fill, several lines.
std::string describe_text(const Scene& scene);

/// The same for programs. Keys: scene, dimension, variables, constraints, free_points,
/// fixed_points, jacobian_rank (null beyond kDenseRankLimit), degrees_of_freedom,
/// degrees_of_freedom_from
/// ("n - rank" or "n - m"), terms {name: count or true/false}, mass, jacobian and tangent
/// {nonzeros, fill} with fill as a share of n^2 or m n, and artificial_fill {asked, natural,
/// reached, seed} or null.
nlohmann::json describe_json(const Scene& scene);

}  // namespace mbs
