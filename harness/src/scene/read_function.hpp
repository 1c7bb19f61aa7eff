// F of the scene format: a number or a function of time.
#pragma once

#include <limits>
#include <string>

#include "mbs/time_function.hpp"
#include "scene/json_node.hpp"

namespace mbs {

/// A function and the longest step (s) that resolves it, infinite unless that is limited.
struct GivenFunction {
  TimeFunction value;
  double longest_step = std::numeric_limits<double>::infinity();
  std::string resolution = {};  ///< what longest_step is, for messages
};

/// Steps a period that a sine needs, in a run. A table needs one a row.
inline constexpr double kStepsPerPeriod = 20.0;

/// Reads a number, {"polynomial": ...}, {"sine": ...} or {"table": ...}; `unit` names it in
/// messages. A table must have at least four rows, start at or before t = 0 and have no corner
/// (corner_of). Throws UsageError.
GivenFunction read_function(const JsonNode& node, const std::string& unit);

}  // namespace mbs
