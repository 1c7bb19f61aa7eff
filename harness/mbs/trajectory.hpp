// The two tables of `mbs simulate`: everything, or what the scene asks for.
#pragma once

#include <string>

#include "mbs/csv_file.hpp"
#include "mbs/simulation.hpp"
#include "run/output_values.hpp"
#include "run/scene_motion.hpp"

namespace mbs {

/// Everything. Columns: t, then NAME.x, NAME.y, NAME.vx, NAME.vy (in 3D also NAME.z, NAME.vz) for
/// each point and unit vector, fixed and driven ones and points of bodies included, then
/// kinetic_energy, potential_energy (J) and constraint_violation, the largest |Phi_k|.
class TrajectoryFile {
 public:
  /// `scene` must outlive the file. Throws UsageError if `path` cannot be written.
  TrajectoryFile(const std::string& path, const Scene& scene);
  void write(double t, const State& state);
  void commit() { file_.commit(); }

 private:
  const Scene& scene_;
  SceneMotion motion_;
  CsvFile file_;
  std::vector<double> row_, phi_;
};

/// What the scene asks for. Columns: t, then those of OutputValues.
class OutputFile {
 public:
  /// `scene` must outlive the file. Throws UsageError if the scene names no outputs or `path`
  /// cannot be written.
  OutputFile(const std::string& path, const Scene& scene);
  /// Takes every state of the run, writes those with `wanted`.
  void follow(double t, const State& state, bool wanted);
  void commit() { file_.commit(); }

 private:
  OutputValues values_;
  CsvFile file_;
};

}  // namespace mbs
