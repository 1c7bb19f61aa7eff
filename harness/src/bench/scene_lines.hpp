// What the table and the summary of a scene have in common: its contenders in order.
#pragma once

#include <string>
#include <vector>

#include "bench/scene_timing.hpp"

namespace mbs {

struct ContenderLine {
  const ContenderResult* contender = nullptr;
  std::string name;           ///< "folder/variant"
  std::vector<double> times;  ///< us a step, by sample; none if it was not timed
  double middle = 0.0;        ///< their median

  /// Whether it has a place among the others: timed, and not the control.
  [[nodiscard]] bool ranked() const { return contender->timed() && !contender->cell->control; }
};

/// The fastest first, then those that were not timed.
std::vector<ContenderLine> contender_lines(const SceneResult& scene);

/// "1.25 (1.21..1.30)": the paired ratio with its interval; no interval from a single sample.
std::string paired_ratio_text(const ContenderLine& line, const ContenderLine& fastest);

/// How many times as long as the processor's the clock's time of all samples is; 1 if there are
/// none.
double clock_factor(const SceneResult& scene);

/// From which clock_factor() on the machine counts as busy.
inline constexpr double kCalm = 1.05;

}  // namespace mbs
