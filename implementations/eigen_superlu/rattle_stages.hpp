// What RATTLE has to know before it starts.
#pragma once

#include <vector>

#include "mbs/simulation.hpp"

namespace mbs::eigen_superlu {

/// Lengths of the stages of a step in their order (s); some are negative.
std::vector<double> rattle_stages(const StepSettings& settings);

/// `model`; throws Unsupported if it has drivers or dampers.
const Model& checked_for_rattle(const Model& model);

}  // namespace mbs::eigen_superlu
