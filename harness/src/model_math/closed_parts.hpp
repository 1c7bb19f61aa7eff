// Which constraints fix coordinates altogether, and which leave them one freedom.
#pragma once

#include <vector>

#include "mbs/model.hpp"

namespace mbs {

/// Rows of Phi and columns of q, ascending.
struct ConstraintBlock {
  std::vector<int> rows, cols;
};

/// The parts of a mechanism whose configurations lie on curves, found by the pattern of Phi_q
/// [Dulmage, Mendelsohn, 1958]; rows that depend on others at the start are left out.
///
/// Example: a crank OA whose angle is driven and a dyad AB, BC, C fixed. `driven` has two blocks,
/// {rod OA, drive} x {A}, which needs itself alone, and {AB, BC} x {B}, which needs both. Without
/// the drive `free` has one part of three rows and four columns.
struct ClosedParts {
  /// Rows that fix as many coordinates at each instant, strongly connected: the sign of their
  /// determinant stays along a motion that goes on without a jump.
  struct Driven {
    ConstraintBlock block;
    std::vector<ConstraintBlock> needed;  ///< the blocks that fix what is in its rows, and itself
    ConstraintBlock all;                  ///< rows and columns of these
  };
  /// Empty unless something is driven.
  std::vector<Driven> driven;
  /// Parts with one column more than rows, which no driver fixes though one may carry them along.
  /// What hangs on a part by a row with two columns or more of its own, such as a wheel or a
  /// pendulum, is none of it.
  std::vector<ConstraintBlock> free;
  /// Columns less independent rows.
  int freedoms = 0;
  /// Of each column: whether the part that it is connected with (ConnectedParts) has more freedoms
  /// than one, and constraints join it to none of `free` that is more than a rod. Those pass energy
  /// on to each other.
  std::vector<bool> passes_on;
  /// Of each column: whether rows of the part that it is connected with were left out because they
  /// depend on others.
  std::vector<bool> has_redundant_rows;
};

/// Parts of more than `largest` rows are left out, and driven blocks that need more than so many.
/// `q` (n) and t: where the rank is looked at.
///
/// [Dulmage, Mendelsohn, 1958] A. L. Dulmage, N. S. Mendelsohn, Coverings of bipartite graphs,
/// Canad. J. Math. 10, 517-534.
ClosedParts closed_parts(const Model& model, const std::vector<double>& q, int largest);

}  // namespace mbs
