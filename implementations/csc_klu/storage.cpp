// Compressed sparse columns: the pattern of a square matrix, and the constant mass matrix M.
#include "storage.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace mbs::csc_klu {

Pattern::Pattern(int columns, std::vector<Position> positions) : column_begin(columns + 1, 0) {
  std::ranges::sort(positions, {}, [](const Position& p) { return std::tuple(p.col, p.row); });
  positions.erase(std::unique(positions.begin(), positions.end()), positions.end());
  row.reserve(positions.size());
  for (const Position& position : positions) {
    row.push_back(position.row);
    ++column_begin[position.col + 1];
  }
  std::partial_sum(column_begin.begin(), column_begin.end(), column_begin.begin());
}

int Pattern::offset(int row_index, int col) const {
  const auto begin = row.begin() + column_begin[col], end = row.begin() + column_begin[col + 1];
  return static_cast<int>(std::lower_bound(begin, end, row_index) - row.begin());
}

std::vector<Pattern::Position> mass_positions(const Model& model) {
  std::vector<Pattern::Position> positions;
  for (const MassEntry& entry : model.mass()) {
    positions.push_back({entry.row, entry.col});
    positions.push_back({entry.col, entry.row});
  }
  return positions;
}

std::vector<double> mass_values(const Model& model, const Pattern& pattern) {
  std::vector<double> values(pattern.entries(), 0.0);
  for (const MassEntry& entry : model.mass()) {
    values[pattern.offset(entry.row, entry.col)] += entry.value;
    if (entry.row != entry.col) values[pattern.offset(entry.col, entry.row)] += entry.value;
  }
  return values;
}

MassMatrix::MassMatrix(const Model& model)
    : pattern_(model.variables(), mass_positions(model)), values_(mass_values(model, pattern_)) {}

void MassMatrix::multiply(const double* x, double* y) const {
  const int* const row = pattern_.row.data();
  const double* const value = values_.data();
  int k = 0;
  for (int i = 0; i < pattern_.columns(); ++i) {
    double sum = 0.0;
    for (const int end = pattern_.column_begin[i + 1]; k < end; ++k) sum += value[k] * x[row[k]];
    y[i] = sum;
  }
}

}  // namespace mbs::csc_klu
