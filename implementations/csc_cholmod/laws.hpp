// Laws of forces in the scale of this folder.
#pragma once

#include "mbs/model.hpp"
#include "mbs/simulation.hpp"

namespace mbs::csc_cholmod {

/// What a force element gives at s and s': Eq. (11) or (18) by parts. Of a spring with a damper eta
/// is 1, kappa(s) is k (s - s_0) and delta(s') is c s'.
struct ElementForce {
  double spring = 0.0;     ///< (dt^2/4) eta kappa(s)
  double damper = 0.0;     ///< (dt^2/4) eta delta(s')
  double stiffness = 0.0;  ///< (dt^2/4) eta kappa'(s)
  double damping = 0.0;    ///< (dt/2) eta delta'(s')
};

class ScaledLaw {
 public:
  /// `law` must outlive this.
  ScaledLaw(const Law& law, const StepSettings& settings) : law_(&law), half_(settings.step / 2.0) {
    drive(0.0);
  }

  [[nodiscard]] bool is_driven() const { return !law_->factor.is_constant(); }
  /// Takes the factor eta at time t.
  void drive(double t) { factor_ = law_->factor.at(t).value; }

  /// `rate`: (dt/2) s'.
  [[nodiscard]] ElementForce at(double s, double rate) const {
    const Curve::Sample kappa = law_->by_position.at(s);
    const Curve::Sample delta = law_->by_rate.at(rate / half_);
    const double damping = half_ * factor_;
    const double scale = half_ * damping;
    return {scale * kappa.value, scale * delta.value, scale * kappa.slope, damping * delta.slope};
  }

 private:
  const Law* law_;
  double half_;  ///< dt/2, s
  double factor_ = 0.0;
};

}  // namespace mbs::csc_cholmod
