// The numbers of torsion springs, torque laws and couples, which turn directions about an axis.
#pragma once

#include <array>
#include <vector>

#include "laws.hpp"
#include "lowered_forces.hpp"
#include "mbs/simulation.hpp"

namespace mbs::csc_cholmod {

/// Torque laws as well. Summands and products come as in Springs.
class TorsionSprings {
 public:
  /// `elements` and `laws`, which they index, must outlive this.
  TorsionSprings(int dimension, const std::vector<TorsionElement>& elements,
                 const std::vector<ScaledLaw>& laws, const StepSettings& settings);

  /// Takes gradients and torques at q and u (all places, m; u = (dt/2) v).
  /// Eqs. (11), (18)
  void evaluate(const double* q, const double* u);
  double* loads(double* summands) const;
  double* tangent(double* products) const;

 private:
  struct Numbers {
    std::array<double, 6> g{};  ///< at b, the negative of that at a; then at c, that of d
    double torque = 0.0;        ///< -(dt^2/4) F
    double weight = 0.0;        ///< (dt/2) c + (dt^2/4) k; of laws their slopes
  };
  [[nodiscard]] ElementForce force(const TorsionElement& element, double angle, double rate) const;

  int dimension_;
  const std::vector<TorsionElement>& elements_;
  const std::vector<ScaledLaw>& laws_;
  double half_;     ///< dt/2, s
  double quarter_;  ///< dt^2/4, s^2
  std::vector<Numbers> numbers_;
};

class Couples {
 public:
  /// `elements` must outlive this.
  Couples(int dimension, const std::vector<CoupleElement>& elements, const StepSettings& settings);

  /// summands = (dt^2/4) torque (z x w) / (w . w) at q (all places, m); returns their end.
  double* loads(const double* q, double* summands) const;

 private:
  int dimension_;
  const std::vector<CoupleElement>& elements_;
  double quarter_;  ///< dt^2/4, s^2
};

}  // namespace mbs::csc_cholmod
