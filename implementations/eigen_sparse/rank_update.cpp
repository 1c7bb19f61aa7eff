// Where the products of rows go in a matrix.
#include "rank_update.hpp"

#include <algorithm>

namespace mbs::eigen_sparse {

int slot_of(const SparseMatrix& matrix, int row, int col) {
  const int* rows = matrix.innerIndexPtr();
  const int* first = rows + matrix.outerIndexPtr()[col];
  const int* last = rows + matrix.outerIndexPtr()[col + 1];
  return static_cast<int>(std::lower_bound(first, last, row) - rows);
}

void append_slots(const Layout& layout, std::span<const int> columns, std::vector<int>& slots) {
  if (layout.matrix == nullptr) return;
  const bool full = layout.triangle == Triangle::full;
  const auto place = [&](int column) {
    return layout.place.empty() ? column : layout.place[column];
  };
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const int row = place(columns[i]);
    for (std::size_t j = 0; j < (full ? columns.size() : i + 1); ++j) {
      const int col = place(columns[j]);
      slots.push_back(full ? slot_of(*layout.matrix, row, col)
                           : slot_of(*layout.matrix, std::min(row, col), std::max(row, col)));
    }
  }
}

AddRows loop_for(Triangle triangle, int width) {
  return triangle == Triangle::full ? loop_for<Triangle::full>(width)
                                    : loop_for<Triangle::upper>(width);
}

}  // namespace mbs::eigen_sparse
