// Factors, the larger the later the lane.
#include "check/varied_lanes.hpp"

#include <algorithm>
#include <utility>

#include "model_math/kinematics.hpp"
#include "run/initial_state.hpp"
#include "scene/time_functions.hpp"

namespace mbs {
namespace {

/// Whether all lengths times a number make the same mechanism, larger: nothing has a length of its
/// own, such as a unit vector or a driver.
bool can_grow(const Model& model) {
  return !is_driven(model) && std::ranges::none_of(model.points(), &Point::is_vector);
}

/// The same curve over numbers `wider` times as large, its values `higher` times as large.
void stretch(Curve& curve, double wider, double higher) {
  for (double& x : curve.breaks) x *= wider;
  for (Curve::Piece& piece : curve.pieces) {
    piece.origin *= wider;
    double factor = higher;
    for (double& c : piece.coefficients) {
      c *= factor;
      factor /= wider;
    }
  }
}

/// `function` as it was at `start` (s), value and rate, and slower from there on: along the way
/// that it took, so that whatever other drivers allow stays allowed when all of them are slowed
/// alike.
class Slowed final : public TimeFunction::Kind {
 public:
  Slowed(TimeFunction function, double start, double slowness)
      : function_(std::move(function)), start_(start), slowness_(slowness) {}

  [[nodiscard]] TimeFunction::Sample at(double t) const override {
    const double along = t - start_, pace = 1 / (1 + slowness_ * along);
    const TimeFunction::Sample then = function_.at(start_ + along * pace);
    const double rate = pace * pace, acceleration = -2 * slowness_ * rate * pace;
    return {then.value, then.rate * rate,
            then.acceleration * rate * rate + then.rate * acceleration};
  }
  [[nodiscard]] double end() const override { return function_.end(); }

 private:
  TimeFunction function_;
  double start_, slowness_;  // s, 1/s
};

/// How one lane differs from the model.
struct Variation {
  double heavier, longer;
  double slightly;  // of what a mechanism feels most: where springs and tables begin
  double start, slowness;

  [[nodiscard]] TimeFunction slowed(const TimeFunction& function) const {
    if (function.is_constant()) return function;
    return TimeFunction(std::make_shared<Slowed>(function, start, slowness));
  }
};

void vary(Law& law, const Variation& by, double wider, double higher) {
  stretch(law.by_position, wider * by.slightly, higher);
  stretch(law.by_rate, wider * by.slightly, higher);
  law.factor = combination({{by.heavier, law.factor}});
}

/// Another mechanism of the same shape. What a row of Phi is multiplied by changes no motion.
ModelData varied(const Model& model, const Variation& by) {
  const double heavier = by.heavier, longer = by.longer;
  ModelData data = model.data();
  std::vector<double> row_factors(data.dot_constraints.size(), 1.0);
  for (Point& point : data.points) {
    for (double& x : point.position) x *= longer;
  }
  for (DotConstraint& c : data.dot_constraints) c.value *= longer * longer;
  for (BilinearConstraint& c : data.bilinear_constraints) {
    for (auto& row : c.B) {
      for (double& entry : row) entry *= heavier;
    }
    c.value *= heavier * longer * longer;
    row_factors.push_back(heavier);
  }
  for (LinearConstraint& c : data.linear_constraints) {
    for (LinearConstraint::Term& term : c.terms) term.coefficient /= heavier;
    c.value *= longer / heavier;
    row_factors.push_back(1 / heavier);
  }
  for (DrivenPoint& point : data.driven_points) {
    for (TimeFunction& position : point.position) position = by.slowed(position);
  }
  for (DrivenValue& driven : data.driven_values) {
    const double factor = row_factors[static_cast<std::size_t>(driven.constraint)];
    driven.value = combination({{factor, by.slowed(driven.value)}});
  }
  for (MassEntry& entry : data.mass) entry.value *= heavier;
  for (DrivenMass& entry : data.driven_mass) entry.value *= heavier;
  for (double& force : data.force) force *= heavier * heavier;
  for (Spring& spring : data.springs) {
    spring.length *= longer * by.slightly;
    spring.stiffness *= heavier;
    spring.damping *= heavier;
  }
  for (TorsionSpring& spring : data.torsion_springs) {
    spring.angle += by.slightly - 1;
    spring.stiffness /= heavier;
    spring.damping /= heavier;
  }
  for (Couple& couple : data.couples) couple.torque /= heavier;
  for (ForceLaw& law : data.force_laws) vary(law.law, by, longer, longer);
  for (TorqueLaw& law : data.torque_laws) vary(law.law, by, 1.0, 1 / (heavier * heavier));
  return data;
}

}  // namespace

VariedLanes vary_lanes(int count, double mass_apart, const Model& model,
                       const StepSettings& settings, const State& start) {
  VariedLanes lanes;
  for (int k = 0; k < count; ++k) {
    constexpr double kSteps = 200;  // in which drivers fall behind as much as masses grow
    const double apart = mass_apart * k, heavier = 1 + apart,
                 longer = can_grow(model) ? 1 + apart / 2 : 1.0;
    lanes.models.push_back(std::make_unique<Model>(varied(
        model, {heavier, longer, 1 + apart / 40, start.t, apart / (kSteps * settings.step)})));
    lanes.pointers.push_back(lanes.models.back().get());
    lanes.settings.push_back(settings);
    lanes.settings.back().penalty *= heavier / (longer * longer);
    std::vector<double> q = start.q, v = start.v;
    for (double& x : q) x *= longer;
    for (double& x : v) x *= longer;
    lanes.starts.push_back(consistent_state(*lanes.models.back(), q, v, start.t));
  }
  return lanes;
}

}  // namespace mbs
