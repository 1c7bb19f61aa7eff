// Names for GoogleTest's parameters.
#pragma once

#include <algorithm>
#include <cctype>
#include <ostream>
#include <string>

#include "registry/registry.hpp"

namespace mbs {

/// How GoogleTest names it.
inline void PrintTo(const NamedVariant& variant, std::ostream* out) { *out << variant.name; }

}  // namespace mbs

namespace mbs::test {

/// `name` with _ for all but letters and digits.
inline std::string gtest_name(std::string name) {
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return !std::isalnum(c); }, '_');
  return name;
}

}  // namespace mbs::test
