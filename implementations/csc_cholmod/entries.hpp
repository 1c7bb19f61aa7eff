// Entries of short rows that share few values, and the numbering of the products of these values.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace mbs::csc_cholmod {

/// Plus or minus a value that is computed in the step, in a column. A distance has 2 x dimension
/// entries and `dimension` values.
struct SignedEntry {
  int column = 0;
  int value = 0;
  bool negative = false;
};

/// Such entries row by row: of the constraints that are not linear, or gradients g of force
/// elements. Entries of fixed points are left out.
class SignedRows {
 public:
  void push(const SignedEntry& entry) { entries_.push_back(entry); }
  void end_row() { start_.push_back(static_cast<int>(entries_.size())); }

  [[nodiscard]] int rows() const { return static_cast<int>(start_.size()) - 1; }
  [[nodiscard]] std::span<const SignedEntry> operator[](int row) const {
    return {entries_.data() + start_[row], entries_.data() + start_[row + 1]};
  }

 private:
  std::vector<int> start_{0};
  std::vector<SignedEntry> entries_;
};

/// Visits (row, first entry, second entry) for each position of one half that the products of two
/// entries of a row go into. Two entries of one column both ways, since both go to the diagonal.
template <typename Visit>
void for_pairs(const SignedRows& rows, Visit visit) {
  for (int row = 0; row < rows.rows(); ++row) {
    const auto entries = rows[row];
    for (std::size_t e = 0; e < entries.size(); ++e) {
      visit(row, entries[e], entries[e]);
      for (std::size_t f = e + 1; f < entries.size(); ++f) {
        visit(row, entries[e], entries[f]);
        if (entries[e].column == entries[f].column) visit(row, entries[f], entries[e]);
      }
    }
  }
}

/// Number of the product of values i and j out of `size`: 00, 01, ... 11, 12, ... in this order.
inline int product_number(int size, int i, int j) {
  const int low = i < j ? i : j;
  const int high = i < j ? j : i;
  return low * size - low * (low - 1) / 2 + high - low;
}
/// How many there are.
inline int product_count(int size) { return size * (size + 1) / 2; }

/// Index of the product of entries e and f of a row among the products of `lowered`, which number
/// products() without their signs, and as many negated ones behind them.
template <typename Lowered>
int signed_product(const Lowered& lowered, int row, const SignedEntry& e, const SignedEntry& f) {
  const int sign = e.negative != f.negative ? lowered.products() : 0;
  return lowered.product(row, e.value, f.value) + sign;
}

}  // namespace mbs::csc_cholmod
