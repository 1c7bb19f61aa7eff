// Merges the columns of coincident points.
#include "columns.hpp"

#include <algorithm>

namespace mbs::ublas_sparse {

void append_columns(const Points& points, Quadratic& constraint, std::vector<Column>& columns) {
  const int begin = static_cast<int>(columns.size());
  const auto add = [&](int point, double by_cd, double by_ab) {
    if (!points.is_free(point)) return;
    const auto same = std::find_if(columns.begin() + begin, columns.end(),
                                   [&](const Column& column) { return column.point == point; });
    if (same == columns.end()) {
      columns.push_back({point, by_cd, by_ab});
    } else {
      same->by_cd += by_cd;
      same->by_ab += by_ab;
    }
  };
  add(constraint.a, 1, 0);
  add(constraint.b, -1, 0);
  add(constraint.c, 0, 1);
  add(constraint.d, 0, -1);
  constraint.columns_begin = begin;
  constraint.columns_end = static_cast<int>(columns.size());
}

void append_positions(const Points& points, const Quadratic& constraint,
                      const std::vector<Column>& columns, std::vector<Entry>& entries) {
  for (int p = constraint.columns_begin; p < constraint.columns_end; ++p) {
    for (int k = 0; k < points.dimension(); ++k) {
      entries.push_back({constraint.row, columns[p].point + k, 0.0});
    }
  }
}

}  // namespace mbs::ublas_sparse
