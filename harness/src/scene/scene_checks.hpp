// Whether a scene as a whole makes sense physically.
#pragma once

#include <string>

#include "mbs/model.hpp"

namespace mbs {

/// |Phi| at the start, relative to the size of its terms. A rod whose "length" is off by the 1e-9
/// that SceneReader allows is off by 2e-9 here.
inline constexpr double kPositionTolerance = 1e-8;
/// |Phi_q v| at the start, relative to |Phi_q| |v|; the energy that the first projection then takes
/// away is the square of it.
inline constexpr double kVelocityTolerance = 1e-6;

/// Throws UsageError, prefixed by `where`, unless: a point is free; every point is touched by a
/// rod, mass or constraint; every free point has mass; no point is held by more constraints than it
/// has coordinates; the start fulfils the constraints to the tolerances above; and the scene can
/// move, judged by the rank of Phi_q up to kDenseRankLimit coordinates and by m <= n beyond. `data`
/// is as SceneReader makes it: points in the order of the file, diagonal of M first.
void check_scene(const ModelData& data, const std::string& where);

}  // namespace mbs
