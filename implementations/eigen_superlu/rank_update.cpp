// Where the products of rows go in the tangent.
#include "rank_update.hpp"

#include <algorithm>

namespace mbs::eigen_superlu {
namespace {

/// Where entry (row, col) is in the arrays of `matrix`.
int slot_of(const SparseMatrix& matrix, int row, int col) {
  const int* rows = matrix.innerIndexPtr();
  const int* first = rows + matrix.outerIndexPtr()[col];
  const int* last = rows + matrix.outerIndexPtr()[col + 1];
  return static_cast<int>(std::lower_bound(first, last, row) - rows);
}

}  // namespace

void append_slots(const SparseMatrix& tangent, Triangle triangle, std::span<const int> columns,
                  std::vector<int>& slots) {
  const bool full = triangle == Triangle::full;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    for (std::size_t j = 0; j < (full ? columns.size() : i + 1); ++j) {
      const auto [low, high] = std::minmax(columns[i], columns[j]);
      slots.push_back(full ? slot_of(tangent, columns[i], columns[j])
                           : slot_of(tangent, low, high));
    }
  }
}

AddRows loop_for(Triangle triangle, int width) {
  return triangle == Triangle::full ? loop_for<Triangle::full>(width)
                                    : loop_for<Triangle::upper>(width);
}

}  // namespace mbs::eigen_superlu
