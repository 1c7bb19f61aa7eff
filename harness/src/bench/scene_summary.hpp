// Who is fastest on a scene, for a reader at a terminal.
#pragma once

#include <string>

#include "bench/scene_timing.hpp"

namespace mbs {

/// `text` broken at blanks for 80 columns, lines after the first begin with four.
std::string filled(const std::string& text);

/// Who takes at most this much longer than the fastest, shown by the 95 % interval, is as fast.
inline constexpr double kAsFast = 1.05;

/// A heading; a line for each timed contender, the fastest first; the shares of the phases, if they
/// were measured; the fastest of either layer; those left out, equal reasons together. No line is
/// longer than 80 columns unless a single name is.
/// @param load of the machine, processes that want to run, this one among them; negative: not known
std::string scene_summary(const SceneResult& scene, double load);

/// The folders that this build does not have, equal reasons together; empty if it has all.
std::string unavailable_summary();

/// What the columns and marks mean.
std::string summary_footer();

}  // namespace mbs
