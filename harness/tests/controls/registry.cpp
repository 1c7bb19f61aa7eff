// The registry of `mbs_controls`: the controls in place of the implementations, and one
// that lacks its library.
#include "registry/registry.hpp"

#include "controls/batches.hpp"
#include "controls/controls.hpp"
#include "controls/planted.hpp"

namespace mbs {

namespace skeleton {
Implementation implementation();
}

const std::vector<RegistryEntry>& registry() {
  static const std::vector<RegistryEntry> entries{
      available("control", test::controls()),
      available("batch", {"the reference in batches", "none", "0", "none", test::batches()}),
      available("planted", {"a beginner's mistake", "none", "0", "none", test::planted()}),
      available("skeleton", skeleton::implementation()),
      unavailable("missing", "Missing is not installed: apt-get install libmissing-dev")};
  return entries;
}

}  // namespace mbs
