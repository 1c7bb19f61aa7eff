// Which fronts a pattern is eliminated in: the best of a few orders, or of points before
// multipliers.
#pragma once

#include <vector>

#include "elimination_tree.hpp"
#include "program.hpp"

namespace mbs::compiled_ldl {

/// Rows of each node: the dimension of a point, 1 of a multiplier.
std::vector<int> sizes_of(const Pattern& pattern);

/// Of a few orders, the tree that is predicted to be factorized first.
Tree best_tree(const Pattern& pattern, int width);

/// Multipliers that no border names go behind the other pivots of their front, where this closes
/// gaps between those that borders name: updates have fewer and longer strips then. Substitutions
/// stay where they are.
void close_gaps(const Pattern& pattern, Tree& tree);

/// Replaces `tree` by the points' fronts and those of −ε − B A⁻¹ Bᵀ, if a pass of Newton's method
/// is predicted to take less time with them; the number of the points' fronts, 0: nothing is
/// replaced.
int eliminate_points_first(const Pattern& pattern, int width, const Changing& changing, Tree& tree,
                           bool& inverts);

}  // namespace mbs::compiled_ldl
