// When the tangent is factorized: paper/other_schemes.md, "Other settings".
#pragma once

#include "mbs/simulation.hpp"

namespace mbs::eigen_dense {

/// Decides it from how fast the passes converge.
///
/// Example, `kept`: max|Δq| = 1e-3, 1e-5, 4e-6 makes the factors due after the third pass of a
/// step, because 4e-6 > 1e-5 / 4.
class TangentSchedule {
 public:
  explicit TangentSchedule(TangentReuse reuse) : reuse_(reuse) {}

  /// Whether factors are kept over steps.
  [[nodiscard]] bool keeps() const { return reuse_ == TangentReuse::kept; }
  /// Whether the next pass assembles and factorizes.
  [[nodiscard]] bool due() const { return due_ || reuse_ == TangentReuse::none; }

  void set_state() { due_ = true; }
  void begin_step() {
    passes_ = 0;
    if (reuse_ == TangentReuse::step) due_ = true;
  }
  void factorized() { due_ = false; }
  /// After a pass with max|Δq| = `size` (m), NaN if it has one; `small`: it is within the
  /// tolerance.
  void after_pass(double size, bool small) {
    const bool slow = passes_ > 0 && !(size <= size_before_ / 4) && !small;
    if (slow && keeps()) due_ = true;
    size_before_ = size;
    ++passes_;
  }
  void end_step(StepStatus status) {
    if (status == StepStatus::pass_limit && keeps()) due_ = true;
  }

 private:
  TangentReuse reuse_;
  bool due_ = true;
  int passes_ = 0;
  double size_before_ = 0.0;
};

}  // namespace mbs::eigen_dense
