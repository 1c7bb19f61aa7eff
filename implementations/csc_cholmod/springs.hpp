// The numbers of springs with dampers and of force laws.
#pragma once

#include <vector>

#include "laws.hpp"
#include "lowered_forces.hpp"
#include "mbs/simulation.hpp"

namespace mbs::csc_cholmod {

/// A spring's share of (dt/2) C + (dt^2/4) K is W e e^T + P (I - e e^T) at (a, a) and (b, b), its
/// negative at (a, b) and (b, a), with W = (dt/2) c + (dt^2/4) k and P = (dt^2/4) p.
/// A law has the slopes of its curves for c and k, Eq. (18).
class Springs {
 public:
  /// `block` and `laws`, which start with those of the block, must outlive this.
  Springs(const SpringBlock& block, const std::vector<ScaledLaw>& laws,
          const StepSettings& settings);

  /// Takes lengths, directions and forces at q and u (all places, m; u = (dt/2) v).
  /// Eqs. (11), (18)
  void evaluate(const double* q, const double* u);
  /// summands = -(dt^2/4) F e; returns their end, as the next does.
  double* loads(double* summands) const;
  /// products: the values of a 2 x 2 block above.
  double* tangent(double* products) const;

 private:
  const SpringBlock& block_;
  const std::vector<ScaledLaw>& laws_;
  double half_;                  ///< dt/2, s
  double quarter_;               ///< dt^2/4, s^2
  std::vector<double> e_;        ///< dimension x count, in runs as in the block
  std::vector<double> force_;    ///< count, N s^2
  std::vector<double> along_;    ///< count, W - P, kg
  std::vector<double> across_;   ///< count, P, kg
  std::vector<double> square_;   ///< count, scratch: L^2
  std::vector<double> product_;  ///< count, scratch: e . difference
};

}  // namespace mbs::csc_cholmod
