// Whether a scene as a whole makes sense physically.
#pragma once

#include <string>

#include "scene_file/lowering.hpp"

namespace mbs {

/// Throws UsageError, prefixed by `where`, unless a point is free, every free point and vector has
/// mass and none is held by more constraints of its own than it has coordinates. For a scene that
/// is lowered, before its assembly.
void check_scene(const Lowered& lowered, const std::string& where);

/// Throws UsageError, prefixed by `where`, if the scene cannot move: judged at the assembled start
/// by the rank of Phi_q, or by m <= n where that is too much work. A scene whose drivers leave it
/// no freedom moves as they say.
void check_mobility(const Lowered& lowered, const std::string& where);

}  // namespace mbs
