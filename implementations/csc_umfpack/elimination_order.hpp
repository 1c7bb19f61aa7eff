// The order in which the saddle-point matrix is eliminated.
#pragma once

#include <vector>

#include "pattern.hpp"
#include "solver.hpp"

namespace mbs::csc_umfpack {

/// Of the variables of T, from the first that is eliminated to the last: AMD's, then the model's;
/// or one as tuned.
Orders orders_of(const SparsityPattern& T, Tuning tuning);

/// The order `coordinates` on the pattern of T, with every multiplier put right after the
/// last of the coordinates that its row of Phi_q has. Multipliers are numbered after the
/// coordinates.
///
/// A multiplier's pivot is then -(epsilon + Phi_q (...)^-1 Phi_q^T), of the size of its row. Before
/// its coordinates it would be epsilon alone, whose inverse is the penalty form's alpha.
///
/// But a row may own some of its coordinates (owned[row]). It comes right after the last of these;
/// rows with one of them wait for the owner's others.
///
/// Example: coordinates in the order 1, 0, 2 and rows {0, 1}, {2} give 1, 0, 3, 2, 4; if the first
/// row owns 1, they give 1, 3, 0, 2, 4.
std::vector<int> elimination_order(const std::vector<int>& coordinates, const Lists& rows,
                                   const Lists& owned);

}  // namespace mbs::csc_umfpack
