// Where the elements of forces.hpp stand in C and K, and what they add there.
#include <utility>

#include "forces.hpp"

namespace mbs::ublas_sparse {
namespace {

/// Calls visit(row, column, x, y, i, j) for the positions of the blocks of all pairs (x, y) of free
/// points among `ends`; i and j are the components within the block.
template <class Ends, class Visit>
void for_each_position(const Points& points, const Ends& ends, Visit visit) {
  const int count = static_cast<int>(ends.size());
  for (int y = 0; y < count; ++y) {
    if (!points.is_free(ends[y])) continue;
    for (int x = 0; x < count; ++x) {
      if (!points.is_free(ends[x])) continue;
      for (int j = 0; j < points.dimension(); ++j) {
        for (int i = 0; i < points.dimension(); ++i) visit(ends[x] + i, ends[y] + j, x, y, i, j);
      }
    }
  }
}

}  // namespace

SparseMatrix Forces::storage(const Points& points, const SparseMatrix& M) const {
  std::vector<Entry> entries = to_entries(M);
  const auto add = [&](int row, int col, int, int, int, int) {
    entries.push_back({row, col, 0.0});
  };
  for (const SpringElement& spring : springs_) {
    for_each_position(points, std::array{spring.a, spring.b}, add);
  }
  for (const TorsionElement& torsion : torsions_) for_each_position(points, torsion.points, add);
  return from_entries(points.variables(), points.variables(), sum_equal(std::move(entries)));
}

void Forces::add_stiffness(const Points& points, SparseMatrix& S) const {
  for (const SpringElement& spring : springs_) {
    const auto add = [&](int row, int col, int x, int y, int i, int j) {
      const double along = (spring.weight - spring.transverse) * spring.e[i] * spring.e[j];
      const double block = i == j ? along + spring.transverse : along;
      S(row, col) += x == y ? block : -block;  // Eq. (11)
    };
    for_each_position(points, std::array{spring.a, spring.b}, add);
  }
  for (const TorsionElement& torsion : torsions_) {
    const auto add = [&](int row, int col, int x, int y, int i, int j) {
      S(row, col) += torsion.weight * torsion.gradient[x][i] * torsion.gradient[y][j];  // Eq. (11)
    };
    for_each_position(points, torsion.points, add);
  }
}

}  // namespace mbs::ublas_sparse
