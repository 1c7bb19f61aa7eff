// Graphs; the order of Cuthill and McKee from both ends.
#include "ordering.hpp"

#include <algorithm>

namespace mbs::compiled_ldl {

Graph graph_of(int nodes, const std::vector<std::vector<int>>& cliques) {
  Graph graph(nodes);
  for (const auto& clique : cliques) {
    for (const int i : clique) {
      for (const int j : clique) {
        if (i != j) graph[i].push_back(j);
      }
    }
  }
  for (auto& list : graph) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }
  return graph;
}

namespace {

/// The component of `start` breadth-first, neighbours by degree: Cuthill and McKee's order.
std::vector<int> breadth_first(const Graph& graph, int start, std::vector<int>& reached) {
  const int round = reached[start] + 1;
  std::vector<int> order = {start};
  reached[start] = round;
  for (std::size_t k = 0; k < order.size(); ++k) {
    const auto begin = static_cast<std::ptrdiff_t>(order.size());
    for (const int i : graph[order[k]]) {
      if (reached[i] == round) continue;
      reached[i] = round;
      order.push_back(i);
    }
    std::stable_sort(order.begin() + begin, order.end(),
                     [&](int a, int b) { return graph[a].size() < graph[b].size(); });
  }
  return order;
}

}  // namespace

std::vector<int> from_both_ends(const Graph& graph) {
  std::vector<int> order, reached(graph.size(), 0);
  for (int i = 0; i < static_cast<int>(graph.size()); ++i) {
    if (reached[i] > 0) continue;
    auto part = breadth_first(graph, i, reached);
    for (int again = 0; again < 2; ++again) part = breadth_first(graph, part.back(), reached);
    for (std::size_t begin = 0, end = part.size(); begin < end;) {
      order.push_back(part[begin++]);
      if (begin < end) order.push_back(part[--end]);
    }
  }
  return order;
}

}  // namespace mbs::compiled_ldl
