// Moves positions and velocities onto the constraints.
#pragma once

#include <span>
#include <vector>

#include "mbs/model.hpp"

namespace mbs {

/// How far the constraints are from being met: |Phi_k| (or its rate) over the size of its terms.
struct Violation {
  double ratio = 0.0;  ///< the worst; infinite if anything is not finite
  int row = -1;        ///< of the worst, -1 if all are met exactly
  double value = 0.0;  ///< of the worst: Phi_k in m^2 (linear: m), or its rate
};

/// Below this ratio constraints count as met: rounding of given numbers.
inline constexpr double kMet = 1e-14;

/// Of Phi(q, t). The terms of a quadratic constraint are |u| |w|, |value| and (|u| + |w|) R, those
/// of a linear one sum |c_k| R and |value|, with R the largest coordinate of a point.
Violation position_violation(const Model& model, double t, std::span<const double> q);

/// Of Phi_q v + Phi_t; the terms of row k are |Phi_t|, sum |Phi_q,ki| max |v| and, if it is
/// quadratic, R max |v|.
Violation velocity_violation(const Model& model, double t, std::span<const double> q,
                             std::span<const double> v);

/// Moves q (n, m) onto Phi(q, t) = 0 by Gauss-Newton steps, each the smallest in the norm of M,
/// damped where it would not help; a q on the constraints to kMet is left bit for bit as it is.
/// Returns what remains: `ratio` is about 1e-15 unless the constraints contradict each other or the
/// start is too far away; q is then the best that was found.
Violation move_onto_constraints(const Model& model, double t, std::vector<double>& q);

/// Changes v (n, m/s) by the smallest in the norm of M so that Phi_q v = -Phi_t, with `weights` as
/// LeastChange has them. A consistent v is left bit for bit as it is. Returns what
/// remains, where the terms count as those of the v given if that is the faster.
Violation make_consistent(const Model& model, double t, std::span<const double> q,
                          std::vector<double>& v, const std::vector<double>& weights = {});

}  // namespace mbs
