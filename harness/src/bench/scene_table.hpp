// What people see of a scene that was timed.
#pragma once

#include <string>

#include "bench/scene_timing.hpp"

namespace mbs {

/// A heading, a line for each contender, the fastest first and failures last, and, if they were
/// measured, the shares of the phases.
std::string scene_table(const SceneResult& scene);

/// What the columns of these tables mean.
std::string table_footer();

}  // namespace mbs
