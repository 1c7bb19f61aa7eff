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

/// What is being caught, in the words of a CellFailure on one line; only within a catch block.
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
  double setup_us = 0.0;      ///< median of up to five: the factory and the first set_state()
  double memory_bytes = 0.0;  ///< what the simulation holds after its first stretch
  long passes = 0;            ///< of the latest stretch
  long steps_at_limit = 0;
  std::optional<double> position_error;                      ///< m, at the end of the stretch
  std::optional<double> constraint_violation, energy_drift;  ///< as Judge defines them
  std::optional<std::array<double, kPhaseCount>> phases;     ///< shares of the time, sum 1
};

/// Time of some steps, s.
struct Spent {
  double seconds = 0.0;      ///< by the clock
  double cpu_seconds = 0.0;  ///< of the processor, without what reading the clocks costs
  Spent& operator+=(const Spent& more);
};

/// Lifecycle: set_up(), one stretch that warms up, accept(); then any number of stretches. A
/// stretch is start() and as many calls of advance() as one likes. Whoever has thrown is not to be
/// called again.
class Measurement {
 public:
  explicit Measurement(const MeasurementTask& task) : task_(task) {}

  /// Creates the simulation at the start of the stretch and times that. Throws what the variant
  /// throws.
  void set_up();
  /// Back to the start.
  void start();
  /// The next steps of the stretch, timed. Throws CellFailure if a tangent cannot be factorized.
  Spent advance(int steps);
  /// At the end of the first stretch: judges the state and profiles another stretch, if asked for.
  /// Throws CellFailure.
  void accept();
  /// Throws CellFailure unless the state is finite; `when` ends its text.
  void require_finite(const char* when = "after a timed stretch");

  /// The whole of set-up and warm-up.
  void prepare();
  /// One stretch; returns its seconds by the clock.
  double time_stretch();

  [[nodiscard]] const CellFigures& figures() const { return figures_; }

 private:
  void judge_end();
  void profile();

  MeasurementTask task_;
  std::unique_ptr<Simulation> simulation_;
  CellFigures figures_;
  int done_ = 0;  ///< steps since start()
  bool accepted_ = false;
};

}  // namespace mbs
