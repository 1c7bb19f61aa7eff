// What README.md claims of stale pivots, checked against what was measured.
#pragma once

#include <string>
#include <vector>

#include "measure.hpp"

namespace mbs::stale_pivots {

struct Claim {
  std::string text;
  bool holds;
};

/// All of them; times are not judged. `rows` are those of all_sequences().
[[nodiscard]] std::vector<Claim> judge(const std::vector<Row>& rows);

}  // namespace mbs::stale_pivots
