// Controls that come back from their step with something wrong, and the one with nothing wrong.
#pragma once

#include <vector>

#include "mbs/implementation.hpp"

namespace mbs::test {

std::vector<Variant> wrong_results();

}  // namespace mbs::test
