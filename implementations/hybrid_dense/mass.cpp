#include "mass.hpp"

#include <algorithm>
#include <numeric>

namespace mbs::hybrid_dense {
namespace {

// Share of M beyond which products with its dense half are faster; measured from 10 to 160
// variables.
constexpr double kDenseFill = 0.2;

struct Cursor {
  const int *row, *column;
  const double* value;
};

// Rows of `Length` entries, 0: of `length`.
template <int Length>
void multiply_rows(int length, int rows, Cursor& at, const double* x, double* y) {
  if constexpr (Length > 0) length = Length;
  for (int r = 0; r < rows; ++r) {
    double sum = 0.0;
    for (int e = 0; e < length; ++e) sum += at.value[e] * x[at.column[e]];
    y[*at.row] = sum;
    ++at.row;
    at.column += length;
    at.value += length;
  }
}

}  // namespace

Mass::Mass(const Model& model, const Slots& slots) : panels_(slots.n) {
  const long n = slots.n;
  if (2.0 * static_cast<double>(model.mass().size()) >
      kDenseFill * static_cast<double>(n * n) + n) {
    dense_ = Array(panels_.size());
    for (const MassEntry& entry : model.mass()) {
      dense_[Panels::position(entry.row, entry.col)] = entry.value;
      if (entry.row / kWidth == entry.col / kWidth) {  // the products read both halves of these
        dense_[Panels::position(entry.col, entry.row)] = entry.value;
      }
    }
    return;
  }
  struct Entry {
    int column;
    double value;
  };
  std::vector<std::vector<Entry>> rows(n);
  for (const MassEntry& entry : model.mass()) {
    rows[entry.row].push_back({entry.col, entry.value});
    if (entry.row != entry.col) rows[entry.col].push_back({entry.row, entry.value});
  }
  rows_.resize(n);
  std::iota(rows_.begin(), rows_.end(), 0);
  std::ranges::stable_sort(rows_, {}, [&](int row) { return rows[row].size(); });
  for (const int row : rows_) {
    const int length = static_cast<int>(rows[row].size());
    if (groups_.empty() || groups_.back().length != length) groups_.push_back({length, 0});
    ++groups_.back().rows;
    for (const Entry& entry : rows[row]) {
      columns_.push_back(entry.column);
      values_.push_back(entry.value);
    }
  }
}

void Mass::multiply(const double* x, double* y) const {
  if (dense_.data() != nullptr) {
    hybrid_dense::multiply(panels_, dense_.data(), x, y);
    return;
  }
  Cursor at{rows_.data(), columns_.data(), values_.data()};
  for (const Group& group : groups_) {
    switch (group.length) {
      case 1:
        multiply_rows<1>(1, group.rows, at, x, y);
        break;
      case 2:
        multiply_rows<2>(2, group.rows, at, x, y);
        break;
      case 3:
        multiply_rows<3>(3, group.rows, at, x, y);
        break;
      case 4:
        multiply_rows<4>(4, group.rows, at, x, y);
        break;
      default:
        multiply_rows<0>(group.length, group.rows, at, x, y);
    }
  }
}

}  // namespace mbs::hybrid_dense
