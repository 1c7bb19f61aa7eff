// Symbolic elimination, merging of fronts by predicted time, order by levels of the tree.
#include "elimination_tree.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "program.hpp"
#include "scalar.hpp"

namespace mbs::compiled_ldl {
namespace {

/// Cycles in which a wide front takes its rows out of others and gives them back.
double widening(int pivots, int border) { return pivots > kPanel && border > 0 ? 200.0 : 0.0; }

}  // namespace

double turns_of_pack(int width) {
  return width == 1 ? 1.0 : static_cast<double>(width) / kRegisterDoubles;
}

/// Constants fitted to measurements of the standard scenes and of filled four-bars, each in several
/// orders, with AVX-512.
FrontTime front_time(int pivots, int border, int nodes, int width) {
  if (width == 1) {  // many side by side: arithmetic counts, others fill what is left
    const double rows = pivots + border;
    return {10.0 + 20.0 * pivots + 0.7 * pivots * rows * rows, 0.0};
  }
  FrontTime time{widening(pivots, border), 0.0};
  for (int from = 0; from < pivots; from += kPanel) {
    const int panel = std::min(kPanel, pivots - from), inside = pivots - from - panel;
    const double packs =
        std::ceil(static_cast<double>(inside + border) / width) * turns_of_pack(width);
    time.work += panel * (20.0 + packs * (panel + 0.35 * inside));
    time.latency += 5.0 * std::ceil(panel / 2.0);  // a division for two pivots
    if (border == 2 && nodes == 1 && pivots <= kPanel) {
      time.work += 10.0;
      time.latency += 15.0;  // Panels::update_two(): a vector waits for stores of single numbers
    } else {
      time.work += border * (5.0 + packs * (2.0 + 0.5 * panel));
    }
  }
  return time;
}

/// A front waits for its children, until the work of those before it has been taken up, and until
/// all of those but the last are done.
double predicted_cycles(const std::vector<FrontTime>& fronts, const std::vector<int>& parents) {
  std::vector<double> ready(fronts.size(), 0.0);
  double entry = 0.0, done = 0.0, done_before = 0.0;  // done_before: all but the last
  for (std::size_t k = 0; k < fronts.size(); ++k) {
    entry = std::max(entry, done_before);
    const double end = std::max(entry, ready[k]) + fronts[k].work + fronts[k].latency;
    if (parents[k] >= 0) ready[parents[k]] = std::max(ready[parents[k]], end);
    done_before = done;
    done = std::max(done, end);
    entry += fronts[k].work;
  }
  return done;
}

namespace {

/// How the time of two fronts is predicted that might become one: the parent waits for its child to
/// the end, or other fronts fill the waiting.
enum class Waiting { counts, is_filled };
/// A front gets wide in several steps, of which the first must not pay for all.
enum class Widening { counts, is_free };

class Symbolic {
 public:
  Symbolic(const Graph& graph, const std::vector<int>& order, const std::vector<int>& sizes,
           int width, std::size_t most)
      : order_(order),
        width_(width),
        count_(static_cast<int>(order.size())),
        place_(count_),
        size_(count_),
        rows_(count_),
        parent_(count_, -1),
        children_(count_) {
    for (int k = 0; k < count_; ++k) place_[order[k]] = k;
    for (int k = 0; k < count_; ++k) size_[k] = sizes[order[k]];
    find_rows(graph, most);
  }

  [[nodiscard]] std::size_t fill() const { return fill_; }

  [[nodiscard]] Tree tree(Waiting waiting, Widening of_wide) const {
    Symbolic copy = *this;
    copy.merge(waiting, of_wide);
    return copy.by_levels();
  }

 private:
  [[nodiscard]] Tree by_levels() const {
    std::vector<int> level(count_, 0), heads;
    for (int k = 0; k < count_; ++k) {
      if (pivots_[k].empty()) continue;
      for (const int c : children_[k]) level[k] = std::max(level[k], level[c] + 1);
      heads.push_back(k);
    }
    std::stable_sort(heads.begin(), heads.end(), [&](int a, int b) { return level[a] < level[b]; });
    Tree tree;
    std::vector<FrontTime> times;
    std::vector<int> index(count_), parents(heads.size(), -1);
    for (const int k : heads) {
      TreeFront front;
      for (const int i : pivots_[k]) front.pivots.push_back(order_[i]);
      for (const int i : rows_[k]) front.border.push_back(order_[i]);
      index[k] = static_cast<int>(times.size());
      for (const int c : children_[k]) parents[index[c]] = index[k];
      const auto nodes = static_cast<int>(rows_[k].size());
      times.push_back(front_time(weight(pivots_[k]), weight(rows_[k]), nodes, width_));
      tree.fronts.push_back(std::move(front));
    }
    tree.cycles = predicted_cycles(times, parents);
    return tree;
  }

  [[nodiscard]] int weight(const std::vector<int>& places) const {
    return std::accumulate(places.begin(), places.end(), 0,
                           [&](int sum, int k) { return sum + size_[k]; });
  }

  /// Stops where the fill is above `most`.
  void find_rows(const Graph& graph, std::size_t most) {
    std::vector<int> mark(count_, -1);
    for (int k = 0; k < count_; ++k) {
      auto& rows = rows_[k];
      mark[k] = k;
      const auto add = [&](int i) {
        if (i <= k || mark[i] == k) return;
        mark[i] = k;
        rows.push_back(i);
      };
      for (const int node : graph[order_[k]]) add(place_[node]);
      for (const int c : children_[k]) std::for_each(rows_[c].begin(), rows_[c].end(), add);
      fill_ += rows.size();
      if (fill_ > most) return;
      if (rows.empty()) continue;
      parent_[k] = *std::min_element(rows.begin(), rows.end());
      children_[parent_[k]].push_back(k);
    }
  }

  void merge(Waiting waiting, Widening of_wide) {
    std::vector<int> pivot_weight(size_), border_weight(count_);
    const auto cycles = [&](int pivots, int k) {  // of a front with the border of k
      const auto nodes = static_cast<int>(rows_[k].size());
      const FrontTime time = front_time(pivots, border_weight[k], nodes, width_);
      const double free = of_wide == Widening::is_free ? widening(pivots, border_weight[k]) : 0.0;
      return time.work - free + (waiting == Waiting::counts ? time.latency : 0.0);
    };
    pivots_.resize(count_);
    for (int k = 0; k < count_; ++k) {
      pivots_[k] = {k};
      border_weight[k] = weight(rows_[k]);
    }
    for (int k = 0; k < count_; ++k) {
      auto& children = children_[k];
      std::stable_sort(children.begin(), children.end(),
                       [&](int a, int b) { return border_weight[a] > border_weight[b]; });
      std::vector<int> kept;
      std::vector<std::vector<int>> merged;
      for (const int c : children) {
        const int both = pivot_weight[c] + pivot_weight[k];
        if (cycles(both, k) > cycles(pivot_weight[c], c) + cycles(pivot_weight[k], k)) {
          kept.push_back(c);
          continue;
        }
        pivot_weight[k] = both;
        merged.push_back(std::move(pivots_[c]));
        pivots_[c].clear();
        kept.insert(kept.end(), children_[c].begin(), children_[c].end());
      }
      children = std::move(kept);
      if (!merged.empty()) {
        std::vector<int> all;
        for (const auto& part : merged) all.insert(all.end(), part.begin(), part.end());
        all.insert(all.end(), pivots_[k].begin(), pivots_[k].end());
        pivots_[k] = std::move(all);
      }
    }
  }

  const std::vector<int>& order_;
  int width_, count_;
  std::size_t fill_ = 0;
  std::vector<int> place_, size_;
  std::vector<std::vector<int>> rows_;  // later places that a place is coupled with
  std::vector<int> parent_;
  std::vector<std::vector<int>> children_, pivots_;
};

}  // namespace

Tree eliminate(const Graph& graph, const std::vector<int>& order, const std::vector<int>& sizes,
               int width, std::size_t most) {
  const Symbolic symbolic(graph, order, sizes, width, most);
  if (symbolic.fill() > most) return {};
  Tree tree = symbolic.tree(Waiting::counts, Widening::counts);
  const auto take = [&tree](Tree other) {
    if (other.cycles < tree.cycles) tree = std::move(other);
  };
  if (width != 1) {  // there are latencies and wide fronts
    take(symbolic.tree(Waiting::is_filled, Widening::counts));
    take(symbolic.tree(Waiting::counts, Widening::is_free));
    take(symbolic.tree(Waiting::is_filled, Widening::is_free));
  }
  // Merged one by one, many narrow fronts never get there.
  const FrontTime time = front_time(std::accumulate(sizes.begin(), sizes.end(), 0), 0, 0, width);
  take({.fronts = {{order, {}}}, .cycles = time.work + time.latency});
  tree.fill = symbolic.fill();
  return tree;
}

}  // namespace mbs::compiled_ldl
