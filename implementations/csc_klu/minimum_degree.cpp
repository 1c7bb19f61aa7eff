// A minimum-degree order in which some vertices wait for others.
#include "minimum_degree.hpp"

#include <algorithm>
#include <iterator>
#include <set>
#include <tuple>

namespace mbs::csc_klu {

std::vector<int> minimum_degree_order(const Pattern& pattern, Precedence precedence) {
  const int size = pattern.columns();
  std::vector<std::vector<int>> neighbours(size);  // that are left, ascending
  std::vector<int> height(size, 0);                // eliminations below, one above the other
  std::set<std::tuple<std::size_t, int, int>> queue;
  const auto key = [&](int v) { return std::tuple(neighbours[v].size(), height[v], v); };
  for (int v = 0; v < size; ++v) {
    const auto row = pattern.row.begin();
    std::remove_copy(row + pattern.column_begin[v], row + pattern.column_begin[v + 1],
                     std::back_inserter(neighbours[v]), v);
    if (precedence.is_free(v)) queue.insert(key(v));
  }
  std::vector<bool> is_out(size, false);
  std::vector<int> order, merged, freed;
  const auto take_out = [&](int v) {
    order.push_back(v);
    is_out[v] = true;
    precedence.take_out(v, [&](int u) { freed.push_back(u); });
  };
  const auto enqueue = [&](int u) {
    if (!is_out[u] && precedence.is_free(u)) queue.insert(key(u));
  };
  while (!queue.empty()) {
    const int v = std::get<2>(*queue.begin());
    queue.erase(queue.begin());
    const std::vector<int> front = std::move(neighbours[v]);
    for (const int u : front) {
      if (precedence.is_free(u)) queue.erase(key(u));
      merged.clear();
      std::ranges::set_union(neighbours[u], front, std::back_inserter(merged));
      std::erase_if(merged, [&](int w) { return w == u || w == v; });
      neighbours[u].assign(merged.begin(), merged.end());
    }
    const std::size_t before = order.size();
    freed.clear();
    take_out(v);
    for (const int u : front) {  // without a neighbour outside, it fills nothing either
      if (precedence.is_free(u) && neighbours[u].size() + 1 == front.size()) take_out(u);
    }
    const int top = height[v] + static_cast<int>(order.size() - before);
    for (const int u : front) {
      std::erase_if(neighbours[u], [&](int w) { return is_out[w]; });
      height[u] = std::max(height[u], top);
      enqueue(u);
    }
    std::ranges::for_each(freed, enqueue);
  }
  return order;
}

}  // namespace mbs::csc_klu
