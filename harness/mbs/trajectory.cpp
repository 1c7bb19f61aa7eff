// From states to rows.
#include "mbs/trajectory.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "model_math/kinematics.hpp"
#include "usage_error.hpp"

namespace mbs {
namespace {

std::vector<std::string> trajectory_columns(const Scene& scene) {
  const std::string axes = scene.model.dimension() == 2 ? "xy" : "xyz";
  const SceneMotion motion(scene);
  std::vector<std::string> columns{"t"};
  for (int i = 0; i < motion.points(); ++i) {
    for (const char axis : axes) columns.push_back(fmt::format("{}.{}", motion.name(i), axis));
    for (const char axis : axes) columns.push_back(fmt::format("{}.v{}", motion.name(i), axis));
  }
  columns.insert(columns.end(), {"kinetic_energy", "potential_energy", "constraint_violation"});
  return columns;
}

std::vector<std::string> output_columns(const Scene& scene, const OutputValues& values) {
  if (values.columns().empty()) {
    throw UsageError(
        fmt::format("--output: scene {} names no \"outputs\"; --trajectory FILE writes all points",
                    scene.name));
  }
  std::vector<std::string> columns{"t"};
  columns.insert(columns.end(), values.columns().begin(), values.columns().end());
  return columns;
}

}  // namespace

TrajectoryFile::TrajectoryFile(const std::string& path, const Scene& scene)
    : scene_(scene),
      motion_(scene),
      file_(path, trajectory_columns(scene)),
      phi_(static_cast<std::size_t>(scene.model.constraints())) {}

void TrajectoryFile::write(double t, const State& state) {
  motion_.set(t, state);
  row_.assign(1, t);
  for (int i = 0; i < motion_.points(); ++i) {
    const Vector3 r = motion_.position(i), v = motion_.velocity(i);
    row_.insert(row_.end(), r.begin(), r.begin() + scene_.model.dimension());
    row_.insert(row_.end(), v.begin(), v.begin() + scene_.model.dimension());
  }
  row_.push_back(motion_.kinetic_energy());
  row_.push_back(motion_.potential_energy());
  evaluate_constraints(scene_.model, t, state.q, phi_);
  double largest = 0.0;
  for (const double phi : phi_) {
    largest = std::isnan(phi) ? phi : std::max(largest, std::abs(phi));
  }
  row_.push_back(largest);
  file_.write(row_);
}

OutputFile::OutputFile(const std::string& path, const Scene& scene)
    : values_(scene), file_(path, output_columns(scene, values_)) {}

void OutputFile::follow(double t, const State& state, bool wanted) {
  values_.follow(t, state);
  if (!wanted) return;
  std::vector<double> row{t};
  const std::vector<double> values = values_.values();
  row.insert(row.end(), values.begin(), values.end());
  file_.write(row);
}

}  // namespace mbs
