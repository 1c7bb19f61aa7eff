// Which of a body's points and vectors carry its coordinates.
#pragma once

#include "scene_file/scene_draft.hpp"

namespace mbs {

/// Whether the scene needs coordinates (or, fixed or driven, a place) for a body's item: something
/// but an output or this body refers to it.
bool is_needed(const DraftPoint& point);

/// Fills basis, further and size of every body: the basis is the smallest well-conditioned one
/// among what is needed, fixed and driven items first, then those that lie farthest apart; where
/// too few are needed, the body gets points of its own (in space, if two fixed vectors hold its
/// orientation, a fixed third vector). Needed items beyond that are `further`, fixed or driven ones
/// excepted. Throws UsageError if fixed and driven items leave a body no freedom or contradict it.
void choose_bases(SceneDraft& draft);

}  // namespace mbs
