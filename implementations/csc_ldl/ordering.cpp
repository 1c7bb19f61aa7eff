// AMD for little fill, then the lowest elimination tree that this fill allows.
#include "ordering.hpp"

#include <amd.h>

#include <algorithm>
#include <numeric>
#include <string>

#include "mbs/simulation.hpp"

namespace mbs::csc_ldl {
namespace {

using Lists = std::vector<std::vector<int>>;

Lists neighbours(const EliminationProblem& problem) {
  Lists lists(problem.variables + problem.rows);
  for (const auto& [i, j] : problem.entries) {
    if (i == j) continue;
    lists[i].push_back(j);
    lists[j].push_back(i);
  }
  for (std::vector<int>& list : lists) {
    std::ranges::sort(list);
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }
  return lists;
}

std::vector<int> amd(const Lists& adjacent) {
  std::vector<int> begin = {0}, index, order(adjacent.size());
  index.reserve(1);  // AMD takes no null pointer
  for (const std::vector<int>& list : adjacent) {
    index.insert(index.end(), list.begin(), list.end());
    begin.push_back(static_cast<int>(index.size()));
  }
  const int status = amd_order(static_cast<int>(adjacent.size()), begin.data(), index.data(),
                               order.data(), nullptr, nullptr);
  if (status != AMD_OK) {
    throw Unsupported("AMD cannot order the matrix, status " + std::to_string(status));
  }
  return order;
}

/// Which unknowns have to wait for others.
struct Waiting {
  std::vector<int> left;  ///< of each unknown, how many have to go before it
  Lists rows;             ///< of each variable, those that wait for it
};

Waiting waiting(const EliminationProblem& problem, const Lists& adjacent) {
  Waiting result{std::vector<int>(adjacent.size(), 0), Lists(problem.variables)};
  std::vector<int> owner(problem.variables, -1), waits_for;
  for (int row = 0; row < problem.rows; ++row) {
    for (const int variable : problem.owned[row]) owner[variable] = problem.variables + row;
  }
  for (int row = 0; row < problem.rows; ++row) {
    const int unknown = problem.variables + row;
    waits_for = problem.owned[row];
    if (waits_for.empty()) {
      waits_for = adjacent[unknown];
      for (const int variable : adjacent[unknown]) {
        if (owner[variable] < 0) continue;
        const std::vector<int>& others = adjacent[owner[variable]];
        waits_for.insert(waits_for.end(), others.begin(), others.end());
      }
      std::ranges::sort(waits_for);
      waits_for.erase(std::unique(waits_for.begin(), waits_for.end()), waits_for.end());
    }
    result.left[unknown] = static_cast<int>(waits_for.size());
    for (const int variable : waits_for) result.rows[variable].push_back(unknown);
  }
  return result;
}

/// The same order, but rows that come too early are held back until they may go.
std::vector<int> held_back(const std::vector<int>& order, Waiting waiting) {
  std::vector<int> result;
  std::vector<bool> held(order.size(), false);
  for (const int next : order) {
    held[next] = waiting.left[next] > 0;
    if (held[next]) continue;
    result.push_back(next);
    if (next >= static_cast<int>(waiting.rows.size())) continue;
    for (const int row : waiting.rows[next]) {
      if (--waiting.left[row] == 0 && held[row]) result.push_back(row);
    }
  }
  return result;
}

/// Later neighbours in the filled matrix, by unknown: the pattern of L's columns.
Lists filled(const Lists& adjacent, const std::vector<int>& order) {
  std::vector<int> place(order.size());
  for (std::size_t k = 0; k < order.size(); ++k) place[order[k]] = static_cast<int>(k);
  const auto earlier = [&](int a, int b) { return place[a] < place[b]; };
  Lists later(order.size()), children(order.size());
  std::vector<int> seen(order.size(), -1);
  for (const int i : order) {
    seen[i] = i;
    const auto take = [&](int j) {
      if (seen[j] != i && place[j] > place[i]) later[i].push_back(j);
      seen[j] = i;
    };
    std::ranges::for_each(adjacent[i], take);
    for (const int child : children[i]) std::ranges::for_each(later[child], take);
    if (!later[i].empty()) children[*std::ranges::min_element(later[i], earlier)].push_back(i);
  }
  return later;
}

/// Of all orders with this fill, one with the lowest elimination tree [Jess, Kees 1982]: in every
/// round as many as possible of those go that are not coupled and whose neighbours are all coupled
/// already. Unknowns of one round stand side by side, so that consecutive rows of L do not wait for
/// each other.
std::vector<int> lowest_tree(const std::vector<int>& first_order, const Lists& later,
                             Waiting waiting) {
  const int n = static_cast<int>(first_order.size());
  Lists earlier(n);  // each in the first order
  for (const int i : first_order) {
    for (const int j : later[i]) earlier[j].push_back(i);
  }
  std::vector<bool> gone(n, false), ready(n, false);
  std::vector<int> mark(n, -1), blocked(n, -1), first(n, 0);

  // With u the first of v and its neighbours, all of these are coupled if u is coupled to each:
  // what comes after u and is coupled to it is coupled among itself.
  const auto is_ready = [&](int v) {
    if (waiting.left[v] > 0) return false;
    while (first[v] < static_cast<int>(earlier[v].size()) && gone[earlier[v][first[v]]]) ++first[v];
    if (first[v] == static_cast<int>(earlier[v].size())) return true;
    const int u = earlier[v][first[v]];
    for (const int w : later[u]) mark[w] = v;
    mark[u] = v;
    const auto coupled = [&](int w) { return gone[w] || mark[w] == v; };
    const bool all =
        std::ranges::all_of(earlier[v], coupled) && std::ranges::all_of(later[v], coupled);
    for (const int w : later[u]) mark[w] = -1;
    mark[u] = -1;
    return all;
  };

  std::vector<int> order, candidates, next;
  const auto consider = [&](int v) {
    if (gone[v] || ready[v] || !is_ready(v)) return;
    ready[v] = true;
    candidates.push_back(v);
  };
  std::ranges::for_each(first_order, consider);
  for (int round = 0; static_cast<int>(order.size()) < n; ++round) {
    const std::size_t begin = order.size();
    next.clear();
    for (const int v : candidates) {
      if (blocked[v] == round) {
        next.push_back(v);
        continue;
      }
      order.push_back(v);
      for (const int w : earlier[v]) blocked[w] = round;
      for (const int w : later[v]) blocked[w] = round;
    }
    candidates = next;
    for (std::size_t k = begin; k < order.size(); ++k) {
      gone[order[k]] = true;
      if (order[k] >= static_cast<int>(waiting.rows.size())) continue;
      for (const int row : waiting.rows[order[k]]) --waiting.left[row];
    }
    for (std::size_t k = begin; k < order.size(); ++k) {
      std::ranges::for_each(earlier[order[k]], consider);
      std::ranges::for_each(later[order[k]], consider);
      if (order[k] >= static_cast<int>(waiting.rows.size())) continue;
      std::ranges::for_each(waiting.rows[order[k]], consider);
    }
  }
  return order;
}

}  // namespace

std::vector<int> elimination_order(const EliminationProblem& problem, Order kind) {
  const Lists adjacent = neighbours(problem);
  const Waiting all_waiting = waiting(problem, adjacent);
  const std::vector<int> order = held_back(amd(adjacent), all_waiting);
  if (kind == Order::amd) return order;
  return lowest_tree(order, filled(adjacent, order), all_waiting);
}

}  // namespace mbs::csc_ldl
