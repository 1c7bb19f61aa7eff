// A contender's first stretch, in pieces, so that the hopeless can be left out early.
#pragma once

#include <limits>
#include <optional>

#include "bench/measurement.hpp"

namespace mbs {

/// Usage: look(); if it is fast enough, finish(). Both throw CellFailure, "slower: ..." once
/// `patience` seconds of steps have not been enough for the stretch.
class WarmUp {
 public:
  /// @param measurement set up; must outlive the object
  WarmUp(Measurement& measurement, int steps, std::optional<double> patience)
      : measurement_(&measurement), steps_(steps), patience_(patience) {}

  /// The first steps, from the start on: 16 and a millisecond, fewer if they take a second or more
  /// than `enough` seconds each; a single one if that takes more than `hopeless` seconds.
  void look(double enough = std::numeric_limits<double>::infinity(),
            double hopeless = std::numeric_limits<double>::infinity());
  /// The rest of the stretch.
  void finish();

  /// Processor time a step: of the last half of what has been done, since the very first steps are
  /// cold.
  [[nodiscard]] double step_seconds() const { return step_seconds_; }
  /// Processor time of all steps so far.
  [[nodiscard]] double seconds() const { return spent_.cpu_seconds; }

 private:
  void advance();

  Measurement* measurement_;
  int steps_, done_ = 0;
  std::optional<double> patience_;
  Spent spent_;
  double step_seconds_ = 0.0;
};

}  // namespace mbs
