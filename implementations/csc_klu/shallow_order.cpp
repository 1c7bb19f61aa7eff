// Orders of a symmetric pattern: AMD's, rearranged so that few eliminations wait for one another.
#include "shallow_order.hpp"

#include <amd.h>
#include <colamd.h>

#include <algorithm>
#include <numeric>
#include <utility>

#include "filled_graph.hpp"
#include "mbs/simulation.hpp"

namespace mbs::csc_klu {
namespace {

std::vector<int> amd(const Pattern& pattern) {
  std::vector<int> order(pattern.columns());
  if (amd_order(pattern.columns(), pattern.column_begin.data(), pattern.row.data(), order.data(),
                nullptr, nullptr) < AMD_OK) {
    throw Unsupported("amd_order refused the pattern of the tangent matrix");
  }
  return order;
}

std::vector<int> column_amd(const Pattern& pattern) {
  const int n = pattern.columns(), entries = static_cast<int>(pattern.row.size());
  std::vector<int> work(pattern.row), order(pattern.column_begin);
  work.resize(colamd_recommended(entries, n, n));
  int statistics[COLAMD_STATS];
  if (colamd(n, n, static_cast<int>(work.size()), work.data(), order.data(), nullptr, statistics) ==
      0) {
    throw Unsupported("colamd refused the pattern of the tangent matrix");
  }
  order.pop_back();
  return order;
}

/// What is left of a filled graph while vertices that cause no fill are taken out.
class Remainder {
 public:
  explicit Remainder(const FilledGraph& graph)
      : graph_(graph),
        is_out_(graph.later.size(), false),
        first_(graph.later.size(), 0),
        degree_(graph.later.size()),
        later_(graph.later.size()) {
    for (std::size_t v = 0; v < degree_.size(); ++v) {
      later_[v] = static_cast<int>(graph.later[v].size());
      degree_[v] = later_[v] + static_cast<int>(graph.earlier[v].size());
    }
  }

  /// Whether the neighbours of v are neighbours of one another. The first vertex of v and its
  /// neighbours has later neighbours that are so: v is among them, and needs to have no others.
  [[nodiscard]] bool is_simplicial(int v) {
    const std::vector<int>& earlier = graph_.earlier[v];
    while (first_[v] < std::ssize(earlier) && is_out_[earlier[first_[v]]]) ++first_[v];
    return degree_[v] == later_[first_[v] < std::ssize(earlier) ? earlier[first_[v]] : v];
  }

  /// Takes v out and calls visit(u) for every neighbour.
  template <class Visit>
  void take_out(int v, Visit visit) {
    is_out_[v] = true;
    for (const int u : graph_.earlier[v]) {
      if (is_out_[u]) continue;
      --degree_[u];
      --later_[u];
      visit(u);
    }
    for (const int u : graph_.later[v]) {
      if (is_out_[u]) continue;
      --degree_[u];
      visit(u);
    }
  }

 private:
  const FilledGraph& graph_;
  std::vector<bool> is_out_;
  std::vector<int> first_;   ///< of the earlier neighbours of a vertex, the first that is not out
  std::vector<int> degree_;  ///< neighbours that are not out
  std::vector<int> later_;   ///< those of them that are later
};

}  // namespace

std::vector<int> ordered(const Pattern& pattern, Order order) {
  if (order == Order::amd) return amd(pattern);
  return order == Order::colamd ? column_amd(pattern) : shallow_order(pattern);
}

std::vector<int> shallow_order(const Pattern& pattern) {
  const std::vector<int> given = amd(pattern);
  const FilledGraph graph(pattern, given);
  Remainder remainder(graph);
  std::vector<int> order, candidates(given.size()), next, tier(given.size(), -1);
  std::iota(candidates.begin(), candidates.end(), 0);
  for (int current = 0; !candidates.empty(); ++current) {
    next.clear();
    for (const int v : candidates) {
      // A neighbour of one that this tier has already has to wait for the next tier.
      if (tier[v] == current || !remainder.is_simplicial(v)) continue;
      order.push_back(given[v]);
      remainder.take_out(v, [&](int u) {
        if (std::exchange(tier[u], current) != current) next.push_back(u);
      });
    }
    candidates.swap(next);
  }
  return order;
}

}  // namespace mbs::csc_klu
