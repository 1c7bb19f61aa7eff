// The registry of `mbs_controls`: the controls in place of the implementations.
#include "registry/registry.hpp"

#include "controls/controls.hpp"

namespace mbs {

const std::vector<RegistryEntry>& registry() {
  static const std::vector<RegistryEntry> entries{available("control", test::controls())};
  return entries;
}

}  // namespace mbs
