// Writes a sparse matrix whose entries come in the same order every time.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <utility>
#include <vector>

namespace engines {

/// The first pass records where entries are, settle() makes compressed columns of them, later
/// passes add values through the places that were found: begin(), add() ..., end().
class SparseWriter {
 public:
  void add(std::size_t row, std::size_t column, double value) {
    if (values_ == nullptr) {
      entries_.emplace_back(column, row);
    } else {
      values_[places_[cursor_++]] += value;
    }
  }

  void settle(std::size_t columns) {
    auto sorted = entries_;
    std::ranges::sort(sorted);
    sorted.erase(std::ranges::unique(sorted).begin(), sorted.end());
    starts_.assign(columns + 1, 0);
    for (const auto& [column, row] : sorted) {
      ++starts_[column + 1];
      rows_.push_back(static_cast<std::int64_t>(row));
    }
    for (std::size_t i = 0; i < columns; ++i) starts_[i + 1] += starts_[i];
    for (const auto& entry : entries_)
      places_.push_back(
          static_cast<std::size_t>(std::ranges::lower_bound(sorted, entry) - sorted.begin()));
    entries_.clear();
  }

  /// `values`: as many as rows(), zeros.
  void begin(double* values) {
    values_ = values;
    cursor_ = 0;
  }
  void end() const {
    if (cursor_ != places_.size()) throw std::logic_error("entries of a matrix have changed");
  }

  [[nodiscard]] const std::vector<std::int64_t>& rows() const { return rows_; }
  [[nodiscard]] const std::vector<std::int64_t>& starts() const { return starts_; }

 private:
  std::vector<std::pair<std::size_t, std::size_t>> entries_;  // column, row
  std::vector<std::size_t> places_;
  std::vector<std::int64_t> rows_, starts_;
  double* values_ = nullptr;
  std::size_t cursor_ = 0;
};

}  // namespace engines
