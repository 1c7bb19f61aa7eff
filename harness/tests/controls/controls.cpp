// Gathers the controls into one implementation with a variant each.
#include "controls/controls.hpp"

#include <algorithm>
#include <iterator>
#include <stdexcept>

#include "controls/wrong_endings.hpp"
#include "controls/wrong_results.hpp"
#include "registry/factory.hpp"

namespace mbs::test {

Implementation controls() {
  Implementation result{"the reference with one defect", "none", "0", "none", wrong_results()};
  std::ranges::move(wrong_endings(), std::back_inserter(result.variants));
  for (Variant& one : result.variants) one.serves.terms = all_terms();
  return result;
}

Variant control(const std::string& name) {
  const std::vector<Variant> variants = controls().variants;
  const auto found = std::ranges::find(variants, name, &Variant::name);
  if (found == variants.end()) throw std::invalid_argument("no control is called " + name);
  return *found;
}

}  // namespace mbs::test
