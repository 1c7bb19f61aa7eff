// Sparse QR by Givens rotations, one row at a time.
#include "model_math/jacobian_rank.hpp"

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace mbs {
namespace {

struct Entry {
  int place = 0;  // of the column in the elimination order
  double value = 0.0;
};
using Row = std::vector<Entry>;  // ascending by place

std::vector<int> elimination_order(int rows, int cols, std::span<const JacobianEntry> entries) {
  std::vector<Eigen::Triplet<double>> triplets;
  triplets.reserve(entries.size());
  for (const JacobianEntry& entry : entries) triplets.emplace_back(entry.row, entry.col, 1.0);
  Eigen::SparseMatrix<double> pattern(rows, cols);
  pattern.setFromTriplets(triplets.begin(), triplets.end());
  Eigen::COLAMDOrdering<int>::PermutationType permutation;
  Eigen::COLAMDOrdering<int>()(pattern, permutation);
  return {permutation.indices().data(), permutation.indices().data() + cols};
}

/// R, into which rows are rotated one after the other.
class Triangle {
 public:
  explicit Triangle(int cols) : rows_(static_cast<std::size_t>(cols)) {}

  /// False if nothing of `row` is left: it depends on those before it.
  bool insert(Row row) {
    std::size_t begin = 0;  // what is before it is gone
    while (true) {
      while (begin < row.size() && std::abs(row[begin].value) <= kRankTolerance) ++begin;
      if (begin == row.size()) return false;
      Row& own = rows_[static_cast<std::size_t>(row[begin].place)];
      if (own.empty()) {
        own.assign(row.begin() + static_cast<std::ptrdiff_t>(begin), row.end());
        return true;
      }
      rotate(own, row, begin);
      begin = 0;
    }
  }
  [[nodiscard]] long work() const { return work_; }

 private:
  /// Removes the first entry of `row`, which is in the column of the first of `own`.
  void rotate(Row& own, Row& row, std::size_t begin) {
    const double length = std::hypot(own[0].value, row[begin].value);
    const double cosine = own[0].value / length, sine = row[begin].value / length;
    rotated_.clear();
    rest_.clear();
    rotated_.push_back({own[0].place, length});
    auto x = own.begin() + 1;
    auto y = row.begin() + static_cast<std::ptrdiff_t>(begin) + 1;
    while (x != own.end() || y != row.end()) {
      const bool has_x = x != own.end() && (y == row.end() || x->place <= y->place);
      const bool has_y = y != row.end() && (x == own.end() || y->place <= x->place);
      const int place = has_x ? x->place : y->place;
      const double from_own = has_x ? (x++)->value : 0.0;
      const double from_row = has_y ? (y++)->value : 0.0;
      rotated_.push_back({place, cosine * from_own + sine * from_row});
      rest_.push_back({place, cosine * from_row - sine * from_own});
    }
    work_ += static_cast<long>(rotated_.size());
    own.swap(rotated_);
    row.swap(rest_);
  }

  std::vector<Row> rows_;  // by the place of their first entry
  Row rotated_, rest_;
  long work_ = 0;
};

/// Row of length 1 in elimination order, from entries that all are in it.
Row unit_row(std::span<const JacobianEntry> entries, const std::vector<int>& order) {
  double length = 0.0;
  Row row;
  for (const JacobianEntry& entry : entries) {
    if (!std::isfinite(entry.value)) throw std::invalid_argument("rank of a non-finite matrix");
    length = std::hypot(length, entry.value);
    row.push_back({order[static_cast<std::size_t>(entry.col)], entry.value});
  }
  if (length > 0.0) {
    for (Entry& entry : row) entry.value /= length;
  }
  std::ranges::sort(row, {}, &Entry::place);
  return row;
}

std::optional<RowRank> rank_by_rotations(int rows, int cols,
                                         std::span<const JacobianEntry> entries) {
  RowRank result;
  if (rows == 0 || cols == 0) {
    for (int row = 0; row < rows; ++row) result.dependent.push_back(row);
    return result;
  }
  const std::vector<int> order = elimination_order(rows, cols, entries);
  Triangle triangle(cols);
  auto begin = entries.begin();
  for (int row = 0; row < rows; ++row) {
    auto end = begin;
    while (end != entries.end() && end->row == row) ++end;
    if (triangle.insert(unit_row({begin, end}, order))) {
      ++result.rank;
    } else {
      result.dependent.push_back(row);
    }
    begin = end;
    if (triangle.work() > kRankWork) return std::nullopt;
  }
  return result;
}

/// A matrix and what was found.
struct Found {
  int rows = -1, cols = -1;
  std::vector<JacobianEntry> entries = {};
  std::optional<RowRank> rank = std::nullopt;

  [[nodiscard]] bool is_of(int its_rows, int its_cols,
                           std::span<const JacobianEntry> its_entries) const {
    const auto is_same = [](const JacobianEntry& x, const JacobianEntry& y) {
      return x.row == y.row && x.col == y.col && x.value == y.value;
    };
    return rows == its_rows && cols == its_cols &&
           std::ranges::equal(entries, its_entries, is_same);
  }
};

}  // namespace

std::optional<RowRank> find_rank(int rows, int cols, std::span<const JacobianEntry> entries) {
  // Asked more than once of the same start, and lanes of a sweep often differ in masses only.
  thread_local Found last;
  constexpr std::size_t kMostKept = 10'000;  // entries
  if (last.is_of(rows, cols, entries)) return last.rank;
  const auto result = rank_by_rotations(rows, cols, entries);
  if (entries.size() <= kMostKept) last = {rows, cols, {entries.begin(), entries.end()}, result};
  return result;
}

int rank_of(int rows, int cols, std::span<const JacobianEntry> entries) {
  const auto found = find_rank(rows, cols, entries);
  if (!found) throw std::length_error("rank_of: the matrix is too large");
  return found->rank;
}

std::optional<int> jacobian_rank(const Model& model, std::span<const double> q, double t) {
  const auto found = find_rank(model.constraints(), model.variables(), jacobian(model, t, q));
  if (!found) return std::nullopt;
  return found->rank;
}

}  // namespace mbs
