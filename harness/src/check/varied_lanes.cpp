// Factors, the larger the later the lane.
#include "check/varied_lanes.hpp"

#include <algorithm>

#include "model_math/kinematics.hpp"
#include "run/initial_state.hpp"

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

/// Another mechanism of the same shape.
ModelData varied(const Model& model, double heavier, double longer) {
  ModelData data = model.data();
  for (Point& point : data.points) {
    for (double& x : point.position) x *= longer;
  }
  for (DotConstraint& c : data.dot_constraints) c.value *= longer * longer;
  for (BilinearConstraint& c : data.bilinear_constraints) c.value *= longer * longer;
  for (LinearConstraint& c : data.linear_constraints) c.value *= longer;
  for (MassEntry& entry : data.mass) entry.value *= heavier;
  for (DrivenMass& entry : data.driven_mass) entry.value *= heavier;
  for (double& force : data.force) force *= heavier * heavier;
  for (Spring& spring : data.springs) {
    spring.length *= longer;
    spring.stiffness *= heavier;
  }
  for (TorsionSpring& spring : data.torsion_springs) spring.stiffness /= heavier;
  for (Couple& couple : data.couples) couple.torque /= heavier;
  for (ForceLaw& law : data.force_laws) {
    stretch(law.law.by_position, longer, heavier * longer);
  }
  for (TorqueLaw& law : data.torque_laws) stretch(law.law.by_position, 1.0, 1 / heavier);
  return data;
}

}  // namespace

VariedLanes vary_lanes(int count, double mass_apart, const Model& model,
                       const StepSettings& settings, const State& start) {
  VariedLanes lanes;
  for (int k = 0; k < count; ++k) {
    const double heavier = 1 + mass_apart * k,
                 longer = can_grow(model) ? 1 + mass_apart / 2 * k : 1.0;
    lanes.models.push_back(std::make_unique<Model>(varied(model, heavier, longer)));
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
