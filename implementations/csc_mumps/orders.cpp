// Nested dissection, and minimum degree with low elimination trees.
#include "orders.hpp"

#include <metis.h>

#include <array>
#include <iterator>
#include <set>

#include "mbs/simulation.hpp"

namespace mbs::csc_mumps {

namespace {

/// The neighbours of each variable, from 0.
std::vector<std::set<int>> graph_of(const Triplets& pattern) {
  std::vector<std::set<int>> linked(pattern.order);
  for (std::size_t k = 0; k < pattern.row.size(); ++k) {
    const int i = pattern.row[k] - 1, j = pattern.column[k] - 1;
    if (i == j) continue;
    linked[i].insert(j);
    linked[j].insert(i);
  }
  return linked;
}

}  // namespace

std::vector<int> metis_positions(const Triplets& pattern) {
  std::vector<idx_t> start{0}, others, order(pattern.order), position(pattern.order);
  for (const std::set<int>& list : graph_of(pattern)) {
    others.insert(others.end(), list.begin(), list.end());
    start.push_back(static_cast<idx_t>(others.size()));
  }
  idx_t n = pattern.order;
  if (METIS_NodeND(&n, start.data(), others.data(), nullptr, nullptr, order.data(),
                   position.data()) != METIS_OK) {
    throw Unsupported("METIS refuses to order the pattern");
  }
  for (idx_t& place : position) ++place;
  return {position.begin(), position.end()};
}

std::vector<int> low_tree_positions(const Triplets& pattern) {
  std::vector<std::set<int>> linked = graph_of(pattern);
  std::vector<int> height(linked.size()), position(linked.size());
  const auto rank = [&](int v) {
    return std::array{static_cast<int>(linked[v].size()), height[v], v};
  };
  std::set<std::array<int, 3>> left;
  for (int v = 0; v < pattern.order; ++v) left.insert(rank(v));
  for (int place = 1; !left.empty(); ++place) {
    const int v = left.extract(left.begin()).value().back();
    position[v] = place;
    for (const int u : linked[v]) {
      left.erase(rank(u));
      linked[u].insert(linked[v].begin(), linked[v].end());
      linked[u].erase(u);
      linked[u].erase(v);
      height[u] = std::max(height[u], height[v] + 1);
      left.insert(rank(u));
    }
  }
  return position;
}

}  // namespace mbs::csc_mumps
