// Whether two bodies agree about the points and vectors that they share.
#pragma once

#include <vector>

#include "scene_file/scene_draft.hpp"

namespace mbs {

/// Differences up to here, of the body's size or of a right angle's cosine, are rounding.
inline constexpr double kShapeTolerance = 1e-6;

/// `body` and `other` both have all of `points`. Throws UsageError, naming both bodies and what
/// differs, if these have other distances or angles in one than in the other or are its mirror
/// image.
void check_same_shape(const SceneDraft& draft, int body, int other, const std::vector<int>& points);

}  // namespace mbs
