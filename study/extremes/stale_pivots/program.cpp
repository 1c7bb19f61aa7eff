// Shows when stale pivots lose digits, that the guard notices and what it costs, on matrices whose
// entries change violently. The exit status says whether README.md's claims hold.
#include <cstdio>
#include <string_view>
#include <vector>

#include "claims.hpp"
#include "measure.hpp"
#include "report.hpp"
#include "sequences.hpp"

int main(int argc, char** argv) {
  using namespace mbs::stale_pivots;
  constexpr int kRounds = 5;
  const bool as_json = argc == 2 && std::string_view(argv[1]) == "--json";
  if (argc > 1 && !as_json) {
    std::fputs("usage: stale_pivots [--json]\n", stderr);
    return 2;
  }
  std::vector<Row> rows;
  for (const Sequence& sequence : all_sequences()) {
    const std::vector<Row> more = measure(sequence, kRounds);
    rows.insert(rows.end(), more.begin(), more.end());
  }
  const std::vector<Claim> claims = judge(rows);
  (as_json ? print_json : print_table)(rows, claims);
  for (const Claim& claim : claims) {
    if (!claim.holds) return 1;
  }
  return 0;
}
