// What goes where in the matrix of Eq. (12): order of elimination, pattern, constant values.
#pragma once

#include <vector>

#include "coordinates.hpp"
#include "gather.hpp"
#include "lowered_forces.hpp"
#include "lowering.hpp"
#include "mbs/model.hpp"
#include "mbs/simulation.hpp"
#include "pattern.hpp"
#include "solver.hpp"

namespace mbs::csc_cholmod {

/// Places of the model's unknowns, then of the rows, in the order of elimination. A row comes after
/// all unknowns that it has an entry for. No pivot of a row then is epsilon alone, unless it
/// depends on rows before it: rounding does not grow with alpha. (But a row that owns unknowns, see
/// README.md, may come once these are eliminated.)
///
/// Example, three unknowns, row 0 with entries for 0 and 1, row 1 for 1 and 2: in the order unknown
/// 0, unknown 1, row 0, unknown 2, row 1 the places are {0, 1, 3, 2, 4}.
std::vector<int> saddle_places(const Model& model, Method method);

/// Positions of the matrix, in that order.
HalfPattern saddle_pattern(const Model& model, const Coordinates& coordinates,
                           const LoweredConstraints& lowered, const LoweredForces& forces,
                           const std::vector<int>& place, Half half);

/// M, the linear rows of Phi_q and -epsilon on `pattern`; else zero.
std::vector<double> saddle_constants(const Model& model, const StepSettings& settings,
                                     const Coordinates& coordinates,
                                     const LoweredConstraints& lowered,
                                     const std::vector<int>& place, const HalfPattern& pattern);

/// What goes into which value on `pattern` out of the Jacobian values, as many negated ones, and
/// what Forces::tangent() writes.
std::vector<Contribution> saddle_contributions(const LoweredConstraints& lowered,
                                               const LoweredForces& forces,
                                               const std::vector<int>& place,
                                               const HalfPattern& pattern);

}  // namespace mbs::csc_cholmod
