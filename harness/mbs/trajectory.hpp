// The trajectory file of `mbs simulate`: one row an instant, four columns a named point.
#pragma once

#include <string>

#include "atomic_file.hpp"
#include "mbs/simulation.hpp"

namespace mbs {

/// Writes CSV: t, then NAME.x, NAME.y, NAME.vx, NAME.vy (in 3D also NAME.z, NAME.vz) for each
/// point; a fixed point keeps its place and velocity 0. Numbers round-trip.
class TrajectoryFile {
 public:
  /// `model` must outlive the file. Throws UsageError if `path` cannot be written.
  TrajectoryFile(const std::string& path, const Model& model);
  void write(double t, const State& state);
  /// Makes the file appear under its name.
  void commit() { file_.commit(); }

 private:
  const Model& model_;
  AtomicFile file_;
};

}  // namespace mbs
