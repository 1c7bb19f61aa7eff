// Set-up: calls AMD and merges the multipliers into its order.
#include "elimination_order.hpp"

#include <amd.h>
#include <metis.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <set>
#include <span>
#include <string>

#include "mbs/simulation.hpp"

namespace mbs::csc_umfpack {

namespace {

/// The neighbours of each variable.
std::vector<std::set<int>> graph_of(const SparsityPattern& T) {
  std::vector<std::set<int>> linked(T.variables());
  for (int column = 0; column < T.variables(); ++column) {
    linked[column].insert(T.rows.begin() + T.starts[column], T.rows.begin() + T.starts[column + 1]);
    linked[column].erase(column);
  }
  return linked;
}

/// Minimum degree; of those that have the least, one that is lowest in the elimination tree.
std::vector<int> low_trees(std::vector<std::set<int>> linked) {
  std::vector<int> height(linked.size()), order;
  const auto rank = [&](int v) {
    return std::array{static_cast<int>(linked[v].size()), height[v], v};
  };
  std::set<std::array<int, 3>> left;
  for (int v = 0; v < std::ssize(linked); ++v) left.insert(rank(v));
  while (!left.empty()) {
    const int v = left.extract(left.begin()).value().back();
    order.push_back(v);
    for (const int u : linked[v]) {
      left.erase(rank(u));
      linked[u].insert(linked[v].begin(), linked[v].end());
      linked[u].erase(u);
      linked[u].erase(v);
      height[u] = std::max(height[u], height[v] + 1);
      left.insert(rank(u));
    }
  }
  return order;
}

/// Nested dissection.
std::vector<int> metis(const std::vector<std::set<int>>& linked) {
  std::vector<idx_t> starts{0}, others, order(linked.size()), places(linked.size());
  for (const std::set<int>& list : linked) {
    others.insert(others.end(), list.begin(), list.end());
    starts.push_back(static_cast<idx_t>(others.size()));
  }
  idx_t n = static_cast<idx_t>(linked.size());
  if (METIS_NodeND(&n, starts.data(), others.data(), nullptr, nullptr, order.data(),
                   places.data()) != METIS_OK) {
    throw Unsupported("METIS cannot order the tangent matrix");
  }
  return {order.begin(), order.end()};
}

}  // namespace

Orders orders_of(const SparsityPattern& T, Tuning tuning) {
  if (tuning == Tuning::trees) return {low_trees(graph_of(T))};
  if (tuning == Tuning::metis) return {metis(graph_of(T))};
  const int n = T.variables();
  std::vector<int> amd(n), model(n);
  const int status = amd_order(n, T.starts.data(), T.rows.data(), amd.data(), nullptr, nullptr);
  if (status != AMD_OK) {
    throw Unsupported("AMD cannot order the tangent matrix, status " + std::to_string(status));
  }
  std::iota(model.begin(), model.end(), 0);
  return {amd, model};
}

std::vector<int> elimination_order(const std::vector<int>& coordinates, const Lists& rows,
                                   const Lists& owned) {
  const int n = static_cast<int>(coordinates.size());
  std::vector<int> places(n);
  for (int k = 0; k < n; ++k) places[coordinates[k]] = k + 1;
  const auto last_place = [&places](std::span<const int> some) {
    int last = 0;
    for (const int coordinate : some) last = std::max(last, places[coordinate]);
    return last;
  };
  std::vector<int> owner(n, -1), all;  // all: for every row, the place of its last coordinate, or 0
  for (int row = 0; row < rows.count(); ++row) {
    for (const int coordinate : owned[row]) owner[coordinate] = row;
    all.push_back(last_place(rows[row]));
  }
  Lists last;  // for every row, the place after which its multiplier can follow; 0: at once
  for (int row = 0; row < rows.count(); ++row, last.end_list()) {
    int place = all[row];
    for (const int coordinate : rows[row]) {
      if (owner[coordinate] >= 0) place = std::max(place, all[owner[coordinate]]);
    }
    last.items.push_back(owned[row].empty() ? place : last_place(owned[row]));
  }
  const Lists ready = transpose(last, n + 1);
  std::vector<int> order;
  for (int place = 0; place <= n; ++place) {
    if (place > 0) order.push_back(coordinates[place - 1]);
    for (const int row : ready[place]) order.push_back(n + row);
  }
  return order;
}

}  // namespace mbs::csc_umfpack
