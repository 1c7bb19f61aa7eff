// Each stored entry m_ij of the half serves row i and row j.
#include "mass.hpp"

#include <algorithm>

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
  for (int j = 0; j < pattern.size(); ++j) {
    int first = pattern.column_start()[j];
    int last = pattern.column_start()[j + 1];
    diagonal_[j] = values[half == Half::lower ? first++ : --last];
    add_column(j, pattern.row().data() + first, values.data() + first, last - first);
  }
}

void MassMatrix::add_column(int column, const int* row, const double* value, int count) {
  const std::size_t before = row_.size();
  for (int begin = 0, end = 0; begin < count; begin = end) {
    for (end = begin + 1; end < count && row[end] - row[end - 1] <= kLongestGap + 1;) ++end;
    const int length = row[end - 1] - row[begin] + 1;
    if (length < kShortestRun) {
      row_.insert(row_.end(), row + begin, row + end);
      value_.insert(value_.end(), value + begin, value + end);
      continue;
    }
    segments_.push_back({column, row[begin], length});
    const std::size_t start = segment_value_.size();
    segment_value_.resize(start + length);
    for (int e = begin; e < end; ++e) segment_value_[start + row[e] - row[begin]] = value[e];
  }
  const int entries = static_cast<int>(row_.size() - before);
  if (entries > 0) columns_.push_back({column, entries});
}

template <int kSign>
void MassMatrix::add_off_diagonal(const double* __restrict x, double* __restrict result) const {
  const int* row = row_.data();
  const double* value = value_.data();
  for (const Column& c : columns_) {
    const double x_column = kSign * x[c.column];
    double sum = 0.0;
    for (int e = 0; e < c.entries; ++e, ++row, ++value) {
      sum += *value * x[*row];
      result[*row] += *value * x_column;
    }
    result[c.column] += kSign * sum;
  }
  const double* m = segment_value_.data();
  for (const Segment& s : segments_) {
    result[s.column] += kSign * multiply_segment(m, s.length, x + s.first_row, kSign * x[s.column],
                                                 result + s.first_row);
    m += s.length;
  }
}

void MassMatrix::subtract_product(const double* b, const double* __restrict x,
                                  double* __restrict result) const {
  for (std::size_t j = 0; j < diagonal_.size(); ++j) result[j] = b[j] - diagonal_[j] * x[j];
  add_off_diagonal<-1>(x, result);
}

void MassMatrix::product(const double* __restrict x, double* __restrict result) const {
  for (std::size_t j = 0; j < diagonal_.size(); ++j) result[j] = diagonal_[j] * x[j];
  add_off_diagonal<1>(x, result);
}

void MassMatrix::products(const double* __restrict x, const double* __restrict y,
                          double* __restrict first, double* __restrict second) const {
  for (std::size_t j = 0; j < diagonal_.size(); ++j) {
    first[j] = diagonal_[j] * x[j];
    second[j] = diagonal_[j] * y[j];
  }
  const int* row = row_.data();
  const double* value = value_.data();
  for (const Column& c : columns_) {
    const double x_column = x[c.column];
    const double y_column = y[c.column];
    double first_sum = 0.0;
    double second_sum = 0.0;
    for (int e = 0; e < c.entries; ++e, ++row, ++value) {
      first_sum += *value * x[*row];
      second_sum += *value * y[*row];
      first[*row] += *value * x_column;
      second[*row] += *value * y_column;
    }
    first[c.column] += first_sum;
    second[c.column] += second_sum;
  }
  const double* m = segment_value_.data();
  for (const Segment& s : segments_) {
    const int r = s.first_row;
    first[s.column] += multiply_segment(m, s.length, x + r, x[s.column], first + r);
    second[s.column] += multiply_segment(m, s.length, y + r, y[s.column], second + r);
    m += s.length;
  }
}

}  // namespace mbs::csc_cholmod
