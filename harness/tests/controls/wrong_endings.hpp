// Controls that do not come back from their step, or not in an orderly way.
#pragma once

#include <vector>

#include "mbs/implementation.hpp"

namespace mbs::test {

std::vector<Variant> wrong_endings();

}  // namespace mbs::test
