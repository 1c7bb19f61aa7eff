// Which constraints are redundant, and whether the start is a singular position.
#pragma once

#include <optional>
#include <vector>

#include "mbs/model.hpp"

namespace mbs {

/// The rank of Phi_q at the start and at a position nearby, which tells what holds everywhere from
/// what holds at the start only. Rows are indices into Phi.
struct Structure {
  std::optional<int> rank_at_start;  ///< none if that is too much work
  std::optional<int> rank;           ///< nearby, the one that counts; none if unknown
  std::vector<int> redundant;        ///< rows that follow from the rows before them, everywhere
  std::optional<bool> singular;      ///< whether the rank at the start is lower than nearby
  std::vector<int> singular_rows;    ///< rows that follow from others at the start only
};

/// Moves every free point at random by a thousandth of the shortest length that a constraint
/// measures at it, then back onto the constraints, and compares. Deterministic; linear cost for
/// chains.
Structure find_structure(const Model& model);

}  // namespace mbs
