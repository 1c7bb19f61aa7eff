// What goes where: the pattern of T, its constant values, and lists of contributions.
#pragma once

#include <vector>

#include "gather.hpp"
#include "lowered_forces.hpp"
#include "lowering.hpp"
#include "mbs/model.hpp"
#include "pattern.hpp"

namespace mbs::csc_cholmod {

/// Positions of T, Eq. (5), lower half, in the model's own order.
HalfPattern tangent_pattern(const Model& model);

/// M on `pattern`, extended by zeros. Unknown i of the model is `number[i]` there.
std::vector<double> mass_values(const Model& model, const HalfPattern& pattern,
                                const std::vector<int>& number);
/// values (on `pattern`) += factor * the linear rows' part of Phi_q^T Phi_q.
void add_linear_products(const LinearBlock& linear, const HalfPattern& pattern, double factor,
                         std::vector<double>& values);

/// Which values, out of as many and their negations, go into which row.
void add_row_contributions(const SignedRows& rows, int values, std::vector<Contribution>& result);
/// Which summands of Constraints::multiply() go into which row.
std::vector<Contribution> row_contributions(const LoweredConstraints& lowered);
/// Which products of Constraints::multiply_pairs() go into which value on `pattern`.
std::vector<Contribution> tangent_contributions(const LoweredConstraints& lowered,
                                                const HalfPattern& pattern);
/// The same, with those of Forces::tangent() behind them.
std::vector<Contribution> tangent_contributions(const LoweredConstraints& lowered,
                                                const LoweredForces& forces,
                                                const HalfPattern& pattern);

}  // namespace mbs::csc_cholmod
