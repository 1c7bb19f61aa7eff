// Minimum degree by exact degrees in a quotient graph, and Jess and Kees's algorithm on its fill.
#include "elimination_order.hpp"

#include <algorithm>
#include <compare>
#include <cstddef>
#include <iterator>
#include <set>
#include <utility>

namespace mbs::csc_cholmod {
namespace {

/// The pattern of a factor L. Nodes keep their numbers.
struct Filled {
  std::vector<int> order;               ///< of elimination
  std::vector<std::vector<int>> below;  ///< by node: the others of its column, in any order
};

/// Who still waits for whom.
class Waiting {
 public:
  explicit Waiting(const Before& before) : left_(before.size()), after_(before.size()) {
    for (std::size_t v = 0; v < before.size(); ++v) {
      left_[v] = static_cast<int>(before[v].size());
      for (int u : before[v]) after_[u].push_back(static_cast<int>(v));
    }
  }
  [[nodiscard]] bool may_go(int v) const { return left_[v] == 0; }
  void eliminate(int v) {
    for (int w : after_[v]) --left_[w];
  }
  /// Those that wait for v.
  [[nodiscard]] const std::vector<int>& after(int v) const { return after_[v]; }

 private:
  std::vector<int> left_;
  std::vector<std::vector<int>> after_;
};

/// The graph of what is left of a matrix: edges, and a clique for each eliminated node until
/// another absorbs it.
class QuotientGraph {
 public:
  QuotientGraph(int n, const std::vector<Position>& positions)
      : edges_(n), cliques_(n), members_(n), mark_(n), gone_(n) {
    for (const Position& p : positions) {
      if (p.row == p.column) continue;
      edges_[p.row].push_back(p.column);
      edges_[p.column].push_back(p.row);
    }
  }

  [[nodiscard]] bool gone(int v) const { return gone_[v] != 0; }
  [[nodiscard]] int degree(int v) { return static_cast<int>(neighbours(v).size()); }

  /// Returns the neighbours of v, which become a clique.
  const std::vector<int>& eliminate(int v) {
    members_[v] = neighbours(v);
    gone_[v] = 1;
    const std::vector<int>& absorbed = cliques_[v];
    for (int w : members_[v]) {  // v and they are marked
      std::erase_if(edges_[w], [&](int u) { return mark_[u] == stamp_; });
      std::erase_if(cliques_[w], [&](int c) { return std::ranges::count(absorbed, c) > 0; });
      cliques_[w].push_back(v);
    }
    return members_[v];
  }
  /// Of each eliminated node its neighbours then.
  [[nodiscard]] const std::vector<std::vector<int>>& members() const { return members_; }

 private:
  std::vector<int> neighbours(int v) {
    std::vector<int> result;
    mark_[v] = ++stamp_;
    const auto add = [&](const std::vector<int>& nodes) {
      for (int w : nodes) {
        if (!gone(w) && std::exchange(mark_[w], stamp_) != stamp_) result.push_back(w);
      }
    };
    add(edges_[v]);
    for (int clique : cliques_[v]) add(members_[clique]);
    return result;
  }

  std::vector<std::vector<int>> edges_;    ///< those that no clique has
  std::vector<std::vector<int>> cliques_;  ///< by node: those that it is in
  std::vector<std::vector<int>> members_;  ///< of the clique of each eliminated node
  std::vector<int> mark_;                  ///< stamp_: v or its neighbour, in neighbours(v)
  std::vector<char> gone_;
  int stamp_ = 0;
};

/// Work per node, see cost(), beyond which an order stays as it is: no column then waits long for
/// another, and those with the same rows stay together.
constexpr double kLittleWork = 400.0;

Filled in_order(int n, const std::vector<Position>& positions, const std::vector<int>& order) {
  QuotientGraph graph(n, positions);
  for (int v : order) graph.eliminate(v);
  return {order, graph.members()};
}

Filled in_rounds(int n, const std::vector<Position>& positions, const Before& before) {
  QuotientGraph graph(n, positions);
  Waiting waiting(before);
  std::vector<int> degree(n), order, changed;
  std::set<std::pair<int, int>> ready;  // (degree, node) of those that may go
  for (int v = 0; v < n; ++v) {
    degree[v] = graph.degree(v);
    if (waiting.may_go(v)) ready.emplace(degree[v], v);
  }
  std::vector<int> touched(n);  // last round that eliminated a neighbour
  for (int round = 1; !ready.empty(); ++round) {
    const int least = ready.begin()->first;
    const std::size_t first = order.size();
    for (auto next = ready.begin(); next != ready.end() && next->first == least;) {
      const int v = next->second;
      if (touched[v] == round) {
        ++next;
        continue;
      }
      next = ready.erase(next);
      for (int w : graph.eliminate(v)) {
        if (std::exchange(touched[w], round) != round) changed.push_back(w);
      }
      order.push_back(v);
    }
    for (std::size_t k = first; k < order.size(); ++k) {
      waiting.eliminate(order[k]);
      std::ranges::copy(waiting.after(order[k]), std::back_inserter(changed));
    }
    for (int v : changed) {
      ready.erase({degree[v], v});
      degree[v] = graph.degree(v);
      if (waiting.may_go(v)) ready.emplace(degree[v], v);
    }
    changed.clear();
  }
  return {order, graph.members()};
}

/// The same fill by the lowest tree: each round eliminates whatever can be without further fill, as
/// far as no edge links it.
Filled lowered(const Filled& filled, const Before& before) {
  const std::size_t n = filled.order.size();
  std::vector<int> place(n);
  for (std::size_t k = 0; k < n; ++k) place[filled.order[k]] = static_cast<int>(k);
  const auto earlier = [&](int v, int w) { return place[v] < place[w]; };
  std::vector<std::vector<int>> linked = filled.below;  // to nodes that are left, in the end
  for (int v : filled.order) {
    for (int w : filled.below[v]) linked[w].push_back(v);
  }
  std::vector<char> gone(n);
  std::vector<int> mark(n);
  int stamp = 0;
  // Whether the neighbours of v that are left are a clique: those after the first of them are, so
  // they need only be linked to that.
  const auto adds_no_fill = [&](int v) {
    std::erase_if(linked[v], [&](int w) { return gone[w] != 0; });
    int first = v;
    for (int w : linked[v]) first = std::min(first, w, earlier);
    ++stamp;
    mark[v] = mark[first] = stamp;
    for (int w : filled.below[first]) mark[w] = stamp;
    return std::ranges::all_of(linked[v], [&](int w) { return mark[w] == stamp; });
  };
  Waiting waiting(before);
  Filled result{{}, std::vector<std::vector<int>>(n)};
  std::vector<int> candidates = filled.order, next;
  std::vector<int> touched(n), queued(n);  // last round of each
  const auto eliminate = [&](int v) {
    gone[v] = 1;
    waiting.eliminate(v);
    result.order.push_back(v);
    result.below[v] = linked[v];
  };
  for (int round = 1; !candidates.empty(); ++round) {
    const std::size_t begin = result.order.size();
    for (int v : candidates) {
      if (gone[v] || touched[v] == round || !waiting.may_go(v) || !adds_no_fill(v)) continue;
      eliminate(v);
      std::size_t left = linked[v].size();
      for (int w : result.below[v]) {  // their twins at once: solves take two such columns together
        const bool is_free = std::exchange(touched[w], round) != round && waiting.may_go(w);
        if (!is_free || !adds_no_fill(w) || linked[w].size() + 1 != left) continue;
        eliminate(w);
        --left;
      }
    }
    next.clear();
    const auto queue = [&](int v) {
      if (!gone[v] && std::exchange(queued[v], round) != round) next.push_back(v);
    };
    for (std::size_t k = begin; k < result.order.size(); ++k) {
      std::ranges::for_each(result.below[result.order[k]], queue);
      std::ranges::for_each(waiting.after(result.order[k]), queue);
    }
    std::ranges::sort(next, earlier);
    candidates.swap(next);
  }
  return result;
}

/// Expected work of a factorization with its solves, then the height of the tree. Less is better.
struct Cost {
  double work = 0.0;
  int height = 0;
  auto operator<=>(const Cost&) const = default;
};
Cost cost(const Filled& filled) {
  constexpr double kOfAnEntry = 8.0;  // solves, and what a factorization does besides arithmetic
  double work = 0.0;
  std::vector<int> height(filled.order.size(), 1);
  int highest = 0;
  for (int v : filled.order) {
    const auto entries = static_cast<double>(filled.below[v].size());
    work += entries * (entries + kOfAnEntry);
    highest = std::max(highest, height[v]);
    for (int w : filled.below[v]) height[w] = std::max(height[w], height[v] + 1);
  }
  return {work, highest};
}

}  // namespace

std::vector<int> low_order(int n, const std::vector<Position>& positions,
                           const std::vector<int>& order, const Before& before) {
  Filled best = in_order(n, positions, order);
  if (cost(best).work < kLittleWork * n) {
    best = lowered(best, before);
    Filled rounds = lowered(in_rounds(n, positions, before), before);
    if (cost(rounds) < cost(best)) best = std::move(rounds);
  }
  std::vector<int> result(n);
  for (int k = 0; k < n; ++k) result[best.order[k]] = k;
  return result;
}

}  // namespace mbs::csc_cholmod
