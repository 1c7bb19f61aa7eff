// Maximum cardinality search from a middle outwards, reversed.
#include "elimination_order.hpp"

#include <algorithm>
#include <cstddef>
#include <span>

namespace mbs::csc_cholmod {
namespace {

/// The neighbours of each of n nodes.
class Graph {
 public:
  Graph(int n, const std::vector<Position>& edges) : start_(n + 1), neighbour_(2 * edges.size()) {
    for (const Position& e : edges) {
      ++start_[e.row];
      ++start_[e.column];
    }
    for (int v = 0; v < n; ++v) start_[v + 1] += start_[v];
    for (const Position& e : edges) {
      neighbour_[--start_[e.row]] = e.column;
      neighbour_[--start_[e.column]] = e.row;
    }
  }
  [[nodiscard]] int size() const { return static_cast<int>(start_.size()) - 1; }
  [[nodiscard]] std::span<const int> operator[](int v) const {
    return {neighbour_.data() + start_[v], neighbour_.data() + start_[v + 1]};
  }

 private:
  std::vector<int> start_;
  std::vector<int> neighbour_;
};

/// All nodes that paths from `start` lead to, nearest first. `from` is -1 at each and becomes the
/// node before it on a shortest path, or itself for `start`.
std::vector<int> breadth_first(const Graph& graph, int start, std::vector<int>& from) {
  std::vector<int> reached{start};
  from[start] = start;
  for (std::size_t k = 0; k < reached.size(); ++k) {
    for (int w : graph[reached[k]]) {
      if (from[w] >= 0) continue;
      from[w] = reached[k];
      reached.push_back(w);
    }
  }
  return reached;
}

/// The middle of a long path through the part of the graph that `node` belongs to.
int middle(const Graph& graph, int node, std::vector<int>& from) {
  const std::vector<int> reached = breadth_first(graph, node, from);
  for (int v : reached) from[v] = -1;
  const int end = breadth_first(graph, reached.back(), from).back();
  int length = 0;
  for (int v = end; from[v] != v; v = from[v]) ++length;
  int result = end;
  for (int k = 0; k < length / 2; ++k) result = from[result];
  return result;
}

/// Visits next whatever most visited nodes are linked to, among equals what has waited longest.
/// Reversed, this eliminates the graph of a factor without fill, whatever it starts from.
class MostLinkedFirst {
 public:
  explicit MostLinkedFirst(const Graph& graph)
      : graph_(graph), links_(graph.size()), next_(graph.size()), waiting_(graph.size()) {}

  [[nodiscard]] bool visited(int v) const { return links_[v] < 0; }
  [[nodiscard]] const std::vector<int>& order() const { return order_; }

  void visit_from(int start) {
    waiting_[0].push_back(start);
    for (int most = 0; most >= 0;) {
      if (next_[most] == waiting_[most].size()) {
        --most;
        continue;
      }
      const int v = waiting_[most][next_[most]++];
      if (links_[v] == most) most = visit(v);  // else visited, or it waits elsewhere as well
    }
  }

 private:
  /// Returns the most links of a node that waits.
  int visit(int v) {
    int most = links_[v];
    links_[v] = -1;
    order_.push_back(v);
    for (int w : graph_[v]) {
      if (visited(w)) continue;
      waiting_[++links_[w]].push_back(w);
      most = std::max(most, links_[w]);
    }
    return most;
  }

  const Graph& graph_;
  std::vector<int> links_;                 ///< to visited nodes; -1: visited itself
  std::vector<std::size_t> next_;          ///< in waiting_
  std::vector<std::vector<int>> waiting_;  ///< nodes by their links
  std::vector<int> order_;
};

}  // namespace

std::vector<int> outside_in_order(int n, const std::vector<Position>& filled) {
  const Graph graph(n, filled);
  MostLinkedFirst search(graph);
  std::vector<int> from(n, -1);
  for (int v = 0; v < n; ++v) {
    if (!search.visited(v)) search.visit_from(middle(graph, v, from));
  }
  std::vector<int> result(n);
  int number = n;
  for (int v : search.order()) result[v] = --number;
  return result;
}

}  // namespace mbs::csc_cholmod
