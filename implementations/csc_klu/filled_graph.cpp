// Which entries the factors of a symmetric matrix have in a given order.
#include "filled_graph.hpp"

#include <algorithm>

namespace mbs::csc_klu {

FilledGraph::FilledGraph(const Pattern& pattern, const std::vector<int>& order)
    : earlier(order.size()), later(order.size()) {
  const int n = pattern.columns();
  std::vector<int> place(n), last_seen(n, -1);
  std::vector<std::vector<int>> children(n);  // in the elimination tree
  for (int k = 0; k < n; ++k) place[order[k]] = k;
  for (int k = 0; k < n; ++k) {
    const auto include = [&](int other) {
      if (other <= k || last_seen[other] == k) return;
      last_seen[other] = k;
      later[k].push_back(other);
      earlier[other].push_back(k);
    };
    const int end = pattern.column_begin[order[k] + 1];
    for (int i = pattern.column_begin[order[k]]; i < end; ++i) include(place[pattern.row[i]]);
    for (const int child : children[k]) std::ranges::for_each(later[child], include);
    if (!later[k].empty()) children[*std::ranges::min_element(later[k])].push_back(k);
  }
}

}  // namespace mbs::csc_klu
