// Set-up of patterns.
#include "pattern.hpp"

namespace mbs::csc_mumps {

std::vector<std::vector<RowEntry>> rows_of(const ColumnPattern& pattern, int rows) {
  std::vector<std::vector<RowEntry>> result(rows);
  for (int column = 0; column < pattern.columns(); ++column) {
    for (int k = pattern.start[column]; k < pattern.start[column + 1]; ++k) {
      result[pattern.row[k]].push_back({column, k});
    }
  }
  return result;
}

ColumnPattern pattern_of(int columns, std::vector<std::pair<int, int>> entries) {
  std::sort(entries.begin(), entries.end());
  entries.erase(std::unique(entries.begin(), entries.end()), entries.end());
  ColumnPattern result;
  result.start.assign(columns + 1, 0);
  result.row.reserve(entries.size());
  for (const std::pair<int, int>& entry : entries) {
    ++result.start[entry.first + 1];
    result.row.push_back(entry.second);
  }
  for (int j = 0; j < columns; ++j) result.start[j + 1] += result.start[j];
  return result;
}

}  // namespace mbs::csc_mumps
