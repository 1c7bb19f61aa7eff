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
/// Example: a crank OA whose angle is driven and a dyad AB, BC, C fixed. `driven` has all rows and
/// columns; its blocks are {rod OA, drive} x {A} and {AB, BC} x {B}. Without the drive `free` has
/// one part of three rows and four columns.
struct ClosedParts {
  /// Rows that fix as many coordinates at each instant. Empty unless something is driven.
  ConstraintBlock driven;
  /// Its strongly connected blocks: each is as many rows as columns, and the sign of the
  /// determinant of each stays along a motion that goes on without a jump.
  std::vector<ConstraintBlock> blocks;
  /// Parts with one column more than rows, which no driver fixes though one may carry them along.
  /// What hangs on a part by a row with two columns or more of its own, such as a wheel or a
  /// pendulum, is none of it.
  std::vector<ConstraintBlock> free;
  /// Columns less independent rows.
  int freedoms = 0;
  /// Of each column: whether the part that it is connected with (ConnectedParts) has more freedoms
  /// than one and none of `free` that is more than a rod. Those pass energy on to each other.
  std::vector<bool> passes_on;
  /// Rows were left out because they depend on others.
  bool has_redundant_rows = false;
};

/// Parts of more than `largest` rows are left out. `q` (n) and t: where the rank is looked at.
///
/// [Dulmage, Mendelsohn, 1958] A. L. Dulmage, N. S. Mendelsohn, Coverings of bipartite graphs,
/// Canad. J. Math. 10, 517-534.
ClosedParts closed_parts(const Model& model, const std::vector<double>& q, int largest);

}  // namespace mbs
