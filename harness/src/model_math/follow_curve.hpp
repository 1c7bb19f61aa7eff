// Follows the configurations of a mechanism with no or one freedom from one to another.
#pragma once

#include <optional>
#include <vector>

#include "mbs/model.hpp"
#include "model_math/closed_parts.hpp"

namespace mbs {

/// A configuration on the way, and which way the motion goes there.
struct CurveEnd {
  double t = 0.0;                     ///< s
  const std::vector<double>* q = {};  ///< n, m
  const std::vector<double>* v = {};  ///< n, m/s
};

/// Where the curve led.
struct FollowedCurve {
  enum class End {
    reached,    ///< what was looked for
    elsewhere,  ///< the curve passes it by
    lost,       ///< it could not be followed to its end: a driver beyond reach, or too sharp bends
  };
  End end = End::lost;
  double distance = 0.0;  ///< m, from what was looked for, largest of a coordinate
  bool crossed =
      false;  ///< an exact singular position, where the curve crosses another, was passed
  double least_time = 0.0;  ///< s; driven: the shortest step that bends on the way asked for
};

/// Follows Phi = 0 of the rows and columns given from `from` to `to` by predictor and corrector,
/// with steps as short as the bends of the curve need. `blocks` not empty: driven, along t; no
/// determinant of a block may change its sign on the way but at an exact crossing. Empty: along the
/// arc, in the direction of the velocity at `from`, then in the other. `length` (m): what is small
/// against it, is small; `tolerance` (m): reached.
///
/// Near the change point of a linkage two branches pass each other at a distance of about the
/// square root of what its lengths are off; a step of a simulation goes straight across, and
/// nothing that is looked at from step to step shows it. Here steps are shortened until the
/// determinant keeps its sign. Where two branches meet exactly, the curve between two of its points
/// satisfies the constraints too: that is a crossing, which a motion with inertia passes straight
/// on. [Allgower, Georg, 2003] E. L. Allgower, K. Georg, Introduction to Numerical Continuation
/// Methods, SIAM, ch. 8.
FollowedCurve follow_curve(const Model& model, const ConstraintBlock& part,
                           const std::vector<ConstraintBlock>& blocks, const CurveEnd& from,
                           const CurveEnd& to, double length, double tolerance);

/// Takes a part with one freedom, whose constraints move, along from `from.t` to `to.t`: in small
/// steps of time, each across the curve of that instant, so that it stays on its assembly. `from.v`
/// is along the curve; coordinates of other parts come from both. Returns q (n) with the part's
/// coordinates at `to.t`; none if a bend is too sharp for that.
std::optional<std::vector<double>> carry_along(const Model& model, const ConstraintBlock& part,
                                               const CurveEnd& from, const CurveEnd& to,
                                               double length);

}  // namespace mbs
