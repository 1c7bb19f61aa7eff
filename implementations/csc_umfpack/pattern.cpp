// Set-up: the patterns of M, T and the saddle-point matrix.
#include "pattern.hpp"

#include <algorithm>
#include <numeric>

namespace mbs::csc_umfpack {
int SparsityPattern::position(int row, int col) const {
  const auto first = rows.begin() + starts[col], last = rows.begin() + starts[col + 1];
  return static_cast<int>(std::lower_bound(first, last, row) - rows.begin());
}

Lists transpose(const Lists& lists, int n) {
  Lists result;
  result.starts.assign(n + 1, 0);
  result.items.resize(lists.items.size());
  for (const int item : lists.items) ++result.starts[item + 1];
  std::partial_sum(result.starts.begin(), result.starts.end(), result.starts.begin());
  std::vector<int> next(result.starts.begin(), result.starts.end() - 1);
  for (int r = 0; r < lists.count(); ++r) {
    for (const int item : lists[r]) result.items[next[item]++] = r;
  }
  return result;
}

SparsityPattern mass_pattern(const Model& model) {
  SparsityPattern result;
  result.starts.assign(model.variables() + 1, 0);
  for (const auto& entry : model.mass()) {
    ++result.starts[entry.col + 1];
    if (entry.row != entry.col) ++result.starts[entry.row + 1];
  }
  std::partial_sum(result.starts.begin(), result.starts.end(), result.starts.begin());
  result.rows.resize(result.starts.back());
  std::vector<int> next(result.starts.begin(), result.starts.end() - 1);
  // The Model sorts by column, so what a column has above its diagonal arrives first, and in order.
  for (const auto& entry : model.mass()) {
    result.rows[next[entry.col]++] = entry.row;
    if (entry.row != entry.col) result.rows[next[entry.row]++] = entry.col;
  }
  return result;
}

SparsityPattern union_pattern(const SparsityPattern& mass, const Lists& coupled) {
  const int n = mass.variables();
  const Lists incident = transpose(coupled, n);
  SparsityPattern result;
  result.starts.push_back(0);
  std::vector<int> seen_in(n, -1);  // the last column that a row index was put into
  for (int col = 0; col < n; ++col) {
    const auto add = [&](int row) {
      if (seen_in[row] == col) return;
      seen_in[row] = col;
      result.rows.push_back(row);
    };
    for (int k = mass.starts[col]; k < mass.starts[col + 1]; ++k) add(mass.rows[k]);
    for (const int r : incident[col]) std::ranges::for_each(coupled[r], add);
    std::sort(result.rows.begin() + result.starts.back(), result.rows.end());
    result.starts.push_back(static_cast<int>(result.rows.size()));
  }
  return result;
}

SparsityPattern bordered_pattern(const SparsityPattern& A, const Lists& rows) {
  const int n = A.variables();
  const Lists incident = transpose(rows, n);
  SparsityPattern result;
  result.starts.push_back(0);
  for (int col = 0; col < n; ++col) {
    result.rows.insert(result.rows.end(), A.rows.begin() + A.starts[col],
                       A.rows.begin() + A.starts[col + 1]);
    for (const int r : incident[col]) result.rows.push_back(n + r);
    result.starts.push_back(static_cast<int>(result.rows.size()));
  }
  for (int r = 0; r < rows.count(); ++r) {
    result.rows.insert(result.rows.end(), rows[r].begin(), rows[r].end());
    result.rows.push_back(n + r);
    result.starts.push_back(static_cast<int>(result.rows.size()));
  }
  return result;
}

}  // namespace mbs::csc_umfpack
