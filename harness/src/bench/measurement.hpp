// Times one variant over one stretch of one scene, and judges where it ends.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>

#include "mbs/implementation.hpp"
#include "run/stretch.hpp"
#include "scene/scene.hpp"

namespace mbs {

/// A cell that cannot be timed. what() is "<status>: <reason>", the status being `unsupported`,
/// `factorization-failed`, `diverged` (not finite, or beyond RunBounds at the end of the stretch),
/// `out-of-memory` or `error`.
class CellFailure : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The std::exception in flight in the words of a CellFailure; only within a catch block.
std::string failure_text();

/// What to measure. The references must outlive the Measurement.
struct MeasurementTask {
  const Scene& scene;
  const Variant& variant;
  const Stretch& stretch;
  StepSettings settings;
  bool control = false;  ///< the null variant: its state is no motion and is not judged
  bool phases = false;   ///< also profile one stretch
};

/// Everything about a cell but the times of its stretches.
struct CellFigures {
  double setup_us = 0.0;      ///< median of five: the factory and the first set_state()
  double memory_bytes = 0.0;  ///< what the simulation holds after its first stretch
  long passes = 0;            ///< of the latest stretch
  long steps_at_limit = 0;
  std::optional<double> position_error;                      ///< m, at the end of the stretch
  std::optional<double> constraint_violation, energy_drift;  ///< as Judge defines them
  std::optional<std::array<double, kPhaseCount>> phases;     ///< shares of the time, sum 1
};

/// Lifecycle: prepare(), then any number of time_stretch(); release() frees the simulation and
/// prepare() brings it back.
class Measurement {
 public:
  explicit Measurement(const MeasurementTask& task) : task_(task) {}

  /// Sets the simulation up and runs one stretch that warms it up and is judged. The first call
  /// also measures the set-up and the phases. Throws CellFailure, the same one each time.
  void prepare();
  void release() { simulation_.reset(); }

  /// Runs one stretch from the start state; returns the time of its steps alone, in seconds.
  /// Throws CellFailure if a tangent cannot be factorized.
  double time_stretch();
  /// After timed stretches: throws CellFailure unless the state is finite.
  void require_finite();

  /// Filled by prepare() and time_stretch().
  [[nodiscard]] const CellFigures& figures() const { return figures_; }

 private:
  void try_to_prepare();
  void set_up(int samples);
  void judge_end();
  void profile();

  MeasurementTask task_;
  std::unique_ptr<Simulation> simulation_;
  CellFigures figures_;
  std::optional<std::string> failure_;
  bool prepared_before_ = false;
};

}  // namespace mbs
