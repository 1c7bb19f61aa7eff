// Where everything is at the start, and how fast.
#pragma once

#include "scene_file/scene_draft.hpp"

namespace mbs {

/// Gives every point and vector a position, those without one from the pose of a body that has
/// them: given, or fitted to what has a position. Then gives points without a velocity that of the
/// first body that has them, if the scene says how it moves. Throws UsageError where a place stays
/// open or a body's points are its mirror image.
void place(SceneDraft& draft);

}  // namespace mbs
