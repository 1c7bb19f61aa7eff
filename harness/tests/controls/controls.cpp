// Gathers the controls into one implementation with a variant each.
#include "controls/controls.hpp"

#include <algorithm>
#include <iterator>

#include "controls/wrong_endings.hpp"
#include "controls/wrong_results.hpp"

namespace mbs::test {

Implementation controls() {
  Implementation result{"the reference with one defect", "none", "0", "none", wrong_results()};
  std::ranges::move(wrong_endings(), std::back_inserter(result.variants));
  return result;
}

}  // namespace mbs::test
