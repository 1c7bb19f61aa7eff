// What bodies, rods and point masses add to M, Q and the mass at driven points.
#pragma once

#include <vector>

#include "mbs/model.hpp"
#include "model_math/vector3.hpp"
#include "scene/scene.hpp"

namespace mbs {

/// A thin uniform rod between two points, at least one of them free.
struct Rod {
  int a = 0, b = 0;             ///< indices into ModelData::points
  double mass = 0.0;            ///< kg; 0 for a massless distance
  double squared_length = 0.0;  ///< m^2
  std::string name;
};

/// Collects contributions; finish() writes them. All points that masses refer to must be in
/// data.points, and driven ones in data.driven_points, before.
class MassWriter {
 public:
  explicit MassWriter(ModelData& data);

  /// Adds to twice the kinetic energy r_a' . B r_a' (a = b, B symmetric) or
  /// r_a' . B r_b' + r_b' . B^T r_a', B in kg. Fixed points drop out, driven ones give DrivenMass.
  void add(int a, int b, const Matrix3& B);
  /// Adds a force (N) to Q; on fixed points it has no effect, on driven ones energy alone.
  void push(int point, const Vector3& force);

  void add_point_mass(int point, double mass, const Vector3& gravity);
  /// M: mass/3 at each end and mass/6 between them; Q: half of the weight at each end; and the
  /// distance constraint.
  void add_rod(Rod rod, const Vector3& gravity);

  [[nodiscard]] bool is_driven(int point) const { return driven_[static_cast<std::size_t>(point)]; }

  [[nodiscard]] const DrivenEnergy& driven_energy() const { return driven_energy_; }

  /// Sums up the entries of each position into data.mass, the whole diagonal included.
  void finish();

 private:
  void add_entry(int row, int col, double value);

  ModelData& data_;
  std::vector<MassEntry> entries_;
  std::vector<bool> driven_;
  DrivenEnergy driven_energy_;
};

}  // namespace mbs
