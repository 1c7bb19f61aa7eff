// Rows of few entries one by one; in segments each entry m_ij of the half serves rows i and j.
#include "mass.hpp"

#include <algorithm>
#include <tuple>
#include <type_traits>

namespace mbs::csc_cholmod {
namespace {

constexpr int kWidth = 8;         // lanes of the segment kernel
constexpr int kLongestGap = 4;    // rows that a segment bridges with zeros
constexpr int kShortestRun = 12;  // shorter ones are quicker entry by entry

/// sum of m x over the segment; y += m * x_column.
double multiply_segment(const double* __restrict m, int length, const double* __restrict x,
                        double x_column, double* __restrict y) {
  double lane[kWidth] = {};
  int k = 0;
  for (; k + kWidth <= length; k += kWidth) {
    for (int l = 0; l < kWidth; ++l) lane[l] += m[k + l] * x[k + l];
    for (int l = 0; l < kWidth; ++l) y[k + l] += m[k + l] * x_column;
  }
  double sum = 0.0;
  for (; k < length; ++k) {
    sum += m[k] * x[k];
    y[k] += m[k] * x_column;
  }
  for (double s : lane) sum += s;
  return sum;
}

}  // namespace

MassMatrix::MassMatrix(const Model& model, Half half, const std::vector<int>& number)
    : diagonal_(model.variables()) {
  std::vector<Position> positions;
  for (const MassEntry& e : model.mass()) positions.push_back({number[e.row], number[e.col]});
  const HalfPattern pattern(half, model.variables(), positions);
  std::vector<double> values(pattern.nonzeros());
  for (const MassEntry& e : model.mass()) {
    values[pattern.index({number[e.row], number[e.col]})] = e.value;
  }
  std::vector<Entry> loose;
  for (int j = 0; j < pattern.size(); ++j) {
    int first = pattern.column_start()[j];
    int last = pattern.column_start()[j + 1];
    diagonal_[j] = values[half == Half::lower ? first++ : --last];
    add_column(j, pattern.row().data() + first, values.data() + first, last - first, loose);
  }
  add_rows(loose);
}

void MassMatrix::add_column(int column, const int* row, const double* value, int count,
                            std::vector<Entry>& loose) {
  for (int begin = 0, end = 0; begin < count; begin = end) {
    for (end = begin + 1; end < count && row[end] - row[end - 1] <= kLongestGap + 1;) ++end;
    const int length = row[end - 1] - row[begin] + 1;
    if (length < kShortestRun) {
      for (int e = begin; e < end; ++e) {
        loose.push_back({row[e], column, value[e]});
        loose.push_back({column, row[e], value[e]});
      }
      continue;
    }
    segments_.push_back({column, row[begin], length});
    const std::size_t start = segment_value_.size();
    segment_value_.resize(start + length);
    for (int e = begin; e < end; ++e) segment_value_[start + row[e] - row[begin]] = value[e];
  }
}

void MassMatrix::add_rows(std::vector<Entry>& loose) {
  std::vector<int> entries(diagonal_.size());
  for (const Entry& e : loose) ++entries[e.row];
  std::sort(loose.begin(), loose.end(), [&](const Entry& a, const Entry& b) {
    return std::tuple(entries[a.row], a.row, a.column) <
           std::tuple(entries[b.row], b.row, b.column);
  });
  for (const Entry& e : loose) {
    column_.push_back(e.column);
    value_.push_back(e.value);
    if (!row_.empty() && row_.back() == e.row) continue;
    row_.push_back(e.row);
    if (groups_.empty() || groups_.back().entries != entries[e.row]) {
      groups_.push_back({entries[e.row]});
    }
    ++groups_.back().rows;
  }
}

void MassMatrix::subtract_rows(const double* __restrict x, double* __restrict result) const {
  const int* row = row_.data();
  const int* column = column_.data();
  const double* value = value_.data();
  const auto run = [&](auto entries, int rows) {  // a constant where it is small
    for (int k = 0; k < rows; ++k, column += entries, value += entries) {
      double sum = 0.0;
      for (int e = 0; e < entries; ++e) sum += value[e] * x[column[e]];
      result[*row++] -= sum;
    }
  };
  for (const Group& g : groups_) {
    switch (g.entries) {
      case 1:
        run(std::integral_constant<int, 1>(), g.rows);
        break;
      case 2:
        run(std::integral_constant<int, 2>(), g.rows);
        break;
      case 3:
        run(std::integral_constant<int, 3>(), g.rows);
        break;
      case 4:
        run(std::integral_constant<int, 4>(), g.rows);
        break;
      default:
        run(g.entries, g.rows);
    }
  }
}

void MassMatrix::subtract_product(const double* b, const double* __restrict x,
                                  double* __restrict result) const {
  for (std::size_t j = 0; j < diagonal_.size(); ++j) result[j] = b[j] - diagonal_[j] * x[j];
  subtract_rows(x, result);
  const double* m = segment_value_.data();
  for (const Segment& s : segments_) {
    result[s.column] -=
        multiply_segment(m, s.length, x + s.first_row, -x[s.column], result + s.first_row);
    m += s.length;
  }
}

}  // namespace mbs::csc_cholmod
