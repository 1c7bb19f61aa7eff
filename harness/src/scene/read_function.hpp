// F of the scene format: a number or a function of time.
#pragma once

#include "mbs/time_function.hpp"
#include "scene/json_node.hpp"

namespace mbs {

/// Reads a number, {"polynomial": ...}, {"sine": ...} or {"table": ...}; `unit` names it in
/// messages. A table must have at least four rows, start at or before t = 0 and have no corner
/// (corner_of). Throws UsageError.
TimeFunction read_function(const JsonNode& node, const std::string& unit);

}  // namespace mbs
