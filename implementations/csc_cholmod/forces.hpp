// All force elements: what they add to (dt^2/4) Q and to T.
#pragma once

#include <vector>

#include "gather.hpp"
#include "laws.hpp"
#include "lowered_forces.hpp"
#include "mbs/simulation.hpp"
#include "springs.hpp"
#include "torsion.hpp"

namespace mbs::csc_cholmod {

/// C and K have no storage of their own: elements keep gradients and weights of the last
/// evaluate(), from which T gets its products.
class Forces {
 public:
  /// `lowered` must outlive this.
  Forces(const LoweredForces& lowered, const StepSettings& settings);

  [[nodiscard]] bool empty() const { return lowered_.values() == 0; }
  [[nodiscard]] bool is_driven() const { return !driven_laws_.empty(); }
  /// Takes the laws' factors at time t, for the whole step.
  void drive(double t) {
    for (int k : driven_laws_) laws_[k].drive(t);
  }
  /// Takes all elements at q and u (all places, m; u = (dt/2) v).
  void evaluate(const double* q, const double* u);
  /// result (n) += (dt^2/4) times what they give of Q; q is that of evaluate(). Eqs. (11), (18)
  void add_loads(const double* q, double* result);
  /// products: the summands of (dt/2) C + (dt^2/4) K, then the same negated.
  void tangent(double* products) const;

 private:
  const LoweredForces& lowered_;
  std::vector<ScaledLaw> laws_;   ///< those of `lowered`
  std::vector<int> driven_laws_;  ///< those whose factor is not constant
  Springs springs_;
  TorsionSprings torsions_;
  Couples couples_;
  GatherSchedule load_rows_;
  std::vector<double> summands_;  ///< values, negated values; scratch
};

}  // namespace mbs::csc_cholmod
