// What an output's columns are called in a table of results.
#pragma once

#include <string>
#include <vector>

#include "scene/scene.hpp"

namespace mbs {

/// What the columns of a vector have before the axis's letter; nullptr: the output is one number.
const char* vector_prefix(const Output& output);

/// "tip.x" and so on of a position or a force, "tip.vx" of a velocity, "tip.ax" of an acceleration,
/// else the output's name.
std::vector<std::string> columns_of(const Output& output, int dimension);

}  // namespace mbs
