// What the program prints: a readable table, or JSON.
#include "report.hpp"

#include <cstdio>

namespace mbs::stale_pivots {

void print_table(const std::vector<Row>& rows, const std::vector<Claim>& claims) {
  std::printf("%-25s %-13s %-9s %-9s %8s %8s %10s %8s\n", "sequence", "form", "strategy", "pivots",
              "median", "worst", "re-pivoted", "us");
  for (const Row& row : rows) {
    std::printf("%-25s %-13s %-9s %-9s %8.1e %8.1e %10d %8.2f\n", row.sequence.c_str(),
                row.form.c_str(), row.strategy.c_str(), row.pivoting.c_str(), row.error_median,
                row.error_worst, row.repivotings, row.time_us_median);
  }
  for (const Claim& claim : claims) {
    std::printf("%s  %s\n",
                claim.holds ? "as claimed:    " : "NOT as claimed:", claim.text.c_str());
  }
}

void print_json(const std::vector<Row>& rows, const std::vector<Claim>& claims) {
  // No text here has a character that JSON escapes.
  const char* separator = "";
  std::printf("{\"rows\": [");
  for (const Row& row : rows) {
    std::printf(
        "%s\n  {\"sequence\": \"%s\", \"form\": \"%s\", \"strategy\": \"%s\", \"matrices\": %d, "
        "\"pivoting\": \"%s\", \"error_median\": %.3g, \"error_worst\": %.3g, "
        "\"repivotings\": %d, \"time_us_median\": %.4g}",
        separator, row.sequence.c_str(), row.form.c_str(), row.strategy.c_str(), row.matrices,
        row.pivoting.c_str(), row.error_median, row.error_worst, row.repivotings,
        row.time_us_median);
    separator = ",";
  }
  separator = "";
  std::printf("],\n \"claims\": [");
  for (const Claim& claim : claims) {
    std::printf("%s\n  {\"claim\": \"%s\", \"holds\": %s}", separator, claim.text.c_str(),
                claim.holds ? "true" : "false");
    separator = ",";
  }
  std::printf("]}\n");
}

}  // namespace mbs::stale_pivots
