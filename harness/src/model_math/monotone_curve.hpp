// Curves through tables, and their integrals.
#pragma once

#include <vector>

#include "mbs/curve.hpp"

namespace mbs {

/// The cubic through the rows (x[i], y[i]) that rises and falls with them, Eq. (19); beyond the
/// table it goes straight on. Needs at least two rows and strictly increasing x; two rows make a
/// straight line.
Curve monotone_curve(const std::vector<double>& x, const std::vector<double>& y);

/// Integral from the break where |c| is least to x: of a force its potential, zero there.
/// Zero for a curve without breaks.
double integral(const Curve& curve, double x);

}  // namespace mbs
