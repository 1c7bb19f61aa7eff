// F of the scene format: a number or a function of time.
#pragma once

#include <string>

#include "scene_file/scene_reader.hpp"

namespace mbs {

/// Steps a period that a sine needs, in a run. A table needs one a row.
inline constexpr double kStepsPerPeriod = 20.0;

/// Reads a number, {"polynomial": ...}, {"sine": ...}, {"table": ...} or {"input": ...}; `unit`
/// names it in messages. A table must have at least four rows, start at or before t = 0 and have no
/// corner (corner_of). Unless it is constant it is listed as a driver, with the name and bounds of
/// `driver`. Throws UsageError.
TimeFunction read_driver(SceneReader& reader, const JsonNode& node, const std::string& unit,
                         Driver driver = {});

/// The constraint's "value", if the file has it.
void read_value(SceneReader& reader, DraftConstraint& constraint, const std::string& unit = "",
                Driver driver = {});

}  // namespace mbs
