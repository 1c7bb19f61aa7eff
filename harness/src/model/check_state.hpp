// What a state must be to be taken in.
#pragma once

#include "mbs/simulation.hpp"

namespace mbs {

/// Throws std::invalid_argument on a wrong size or a non-finite number.
void check_state(const State& state, int variables, int constraints);

}  // namespace mbs
