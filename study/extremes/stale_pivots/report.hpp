// What the program prints: a readable table, or JSON.
#pragma once

#include <vector>

#include "claims.hpp"
#include "measure.hpp"

namespace mbs::stale_pivots {

/// One line a row, then one a claim.
void print_table(const std::vector<Row>& rows, const std::vector<Claim>& claims);
/// One document {"rows": [...], "claims": [...]}; rows have the members of Row.
void print_json(const std::vector<Row>& rows, const std::vector<Claim>& claims);

}  // namespace mbs::stale_pivots
