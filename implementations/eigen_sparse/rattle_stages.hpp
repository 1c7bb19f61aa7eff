// What RATTLE has to know before it starts.
#pragma once

#include <vector>

#include "mbs/simulation.hpp"

namespace mbs::eigen_sparse {

/// Lengths of the stages of a step in their order (s); some are negative.
std::vector<double> rattle_stages(const StepSettings& settings);

}  // namespace mbs::eigen_sparse
