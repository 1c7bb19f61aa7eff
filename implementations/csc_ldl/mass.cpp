// Products with M.
#include "mass.hpp"

#include <map>
#include <utility>

#include "sums.hpp"

namespace mbs::csc_ldl {

Mass::Mass(std::span<const MassEntry> entries, const std::vector<int>& place) {
  std::vector<std::map<int, double>> rows(place.size());
  for (const MassEntry& entry : entries) {
    rows[place[entry.row]][place[entry.col]] = entry.value;
    rows[place[entry.col]][place[entry.row]] = entry.value;
  }
  std::map<int, std::vector<int>> by_entries;
  for (int i = 0; i < static_cast<int>(rows.size()); ++i) {
    by_entries[static_cast<int>(rows[i].size())].push_back(i);
  }
  for (const auto& [count, of_count] : by_entries) {
    runs_.push_back({count, static_cast<int>(of_count.size())});
    for (const int i : of_count) {
      row_.push_back(i);
      for (const auto& [j, value] : rows[i]) {
        col_.push_back(j);
        value_.push_back(value);
      }
    }
  }
}

void Mass::multiply(const double* x, double* y) const {
  const int *row = row_.data(), *col = col_.data();
  const double* value = value_.data();
  for (const Run& run : runs_) {
    with_constant(run.entries, [&](auto entries) {
      for (int r = 0; r < run.rows; ++r, col += entries, value += entries) {
        double sum = 0.0;
        for (int k = 0; k < entries; ++k) sum += value[k] * x[col[k]];
        y[*row++] = sum;
      }
    });
  }
}

}  // namespace mbs::csc_ldl
