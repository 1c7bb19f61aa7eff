// The scene's outputs over a run, in three numbers each.
#pragma once

#include <vector>

#include "run/output_values.hpp"

namespace mbs {

/// Of one column of OutputValues, over all steps and the start.
struct Extremes {
  double last = 0.0, least = 0.0, most = 0.0;
};

class OutputExtremes {
 public:
  /// `scene` must outlive this.
  explicit OutputExtremes(const Scene& scene) : outputs_(scene) {}
  /// Takes the next state of the run.
  void follow(double t, const State& state);
  [[nodiscard]] const std::vector<Extremes>& columns() const { return columns_; }

 private:
  OutputValues outputs_;
  std::vector<Extremes> columns_;  // empty before the first state
  std::vector<double> values_;     // of the present one
};

}  // namespace mbs
