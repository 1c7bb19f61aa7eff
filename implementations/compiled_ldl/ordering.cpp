// Graphs; the order of Cuthill and McKee from both ends; approximate minimum degree.
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

// Approximate minimum degree on a quotient graph of variables and elements.

namespace {

/// Nodes by degree, each degree a doubly linked list.
class DegreeLists {
 public:
  DegreeLists(int nodes, Tie tie)
      : tie_(tie),
        head_(nodes + 1, -1),
        tail_(nodes + 1, -1),
        next_(nodes),
        previous_(nodes),
        degree_(nodes, -1) {}

  void insert(int node, int degree) {
    degree_[node] = degree;
    previous_[node] = tail_[degree];
    next_[node] = -1;
    (tail_[degree] < 0 ? head_[degree] : next_[tail_[degree]]) = node;
    tail_[degree] = node;
    least_ = std::min(least_, degree);
  }
  void remove(int node) {
    const int d = degree_[node];
    (previous_[node] < 0 ? head_[d] : next_[previous_[node]]) = next_[node];
    (next_[node] < 0 ? tail_[d] : previous_[next_[node]]) = previous_[node];
  }
  int take_least() {
    while (head_[least_] < 0) ++least_;
    const int node = tie_ == Tie::longest ? head_[least_] : tail_[least_];
    remove(node);
    return node;
  }

 private:
  Tie tie_;
  std::vector<int> head_, tail_, next_, previous_, degree_;
  int least_ = 0;
};

class MinimumDegree {
 public:
  MinimumDegree(const Graph& graph, Tie tie)
      : size_(static_cast<int>(graph.size())),
        variables_(graph),
        elements_(size_),
        members_(size_),
        state_(size_, kVariable),
        mark_(size_, -1),
        outside_(size_, 0),
        outside_mark_(size_, -1),
        lists_(size_, tie) {
    for (int i = 0; i < size_; ++i) lists_.insert(i, static_cast<int>(graph[i].size()));
  }

  std::vector<int> run() {
    std::vector<int> order;
    order.reserve(size_);
    for (int k = 0; k < size_; ++k) {
      const int p = lists_.take_least();
      order.push_back(p);
      eliminate(p);
      count_outside(p);
      for (const int i : members_[p]) update(i, p, size_ - k - 1);
    }
    return order;
  }

 private:
  enum : char { kVariable, kElement, kAbsorbed };

  void eliminate(int p) {
    state_[p] = kElement;
    mark_[p] = p;
    auto& list = members_[p];
    const auto add = [&](const std::vector<int>& nodes) {
      for (const int i : nodes) {
        if (state_[i] != kVariable || mark_[i] == p) continue;
        mark_[i] = p;
        list.push_back(i);
      }
    };
    add(variables_[p]);
    for (const int e : elements_[p]) {
      if (state_[e] != kElement) continue;
      add(members_[e]);
      state_[e] = kAbsorbed;
      std::vector<int>().swap(members_[e]);
    }
    std::vector<int>().swap(variables_[p]);
    std::vector<int>().swap(elements_[p]);
  }

  /// How many members of each element are not members of p.
  void count_outside(int p) {
    for (const int i : members_[p]) {
      for (const int e : elements_[i]) {
        if (state_[e] != kElement) continue;
        if (outside_mark_[e] != p) {
          outside_mark_[e] = p;
          outside_[e] = static_cast<int>(members_[e].size());
        }
        --outside_[e];
      }
    }
  }

  void update(int i, int p, int remaining) {
    std::erase_if(variables_[i], [&](int j) { return state_[j] != kVariable || mark_[j] == p; });
    int degree = static_cast<int>(variables_[i].size() + members_[p].size()) - 1;
    std::erase_if(elements_[i], [&](int e) {
      if (state_[e] != kElement) return true;
      if (outside_[e] == 0) return true;  // all its members are members of p
      degree += outside_[e];
      return false;
    });
    elements_[i].push_back(p);
    lists_.remove(i);
    lists_.insert(i, std::min(degree, remaining - 1));
  }

  int size_;
  Graph variables_;                         // neighbours by an original edge
  std::vector<std::vector<int>> elements_;  // elements that a variable belongs to
  std::vector<std::vector<int>> members_;   // variables of an element
  std::vector<char> state_;
  std::vector<int> mark_, outside_, outside_mark_;
  DegreeLists lists_;
};

}  // namespace

std::vector<int> minimum_degree(const Graph& graph, Tie tie) {
  return MinimumDegree(graph, tie).run();
}

}  // namespace mbs::compiled_ldl
