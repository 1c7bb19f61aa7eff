// Minimum degree on unknowns and multipliers, multipliers among unknowns, and what both take.
#include "saddle_order.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <numeric>
#include <set>

namespace mbs::eigen_sparse {
namespace {

/// Those of a factorization and three solves on a column of L with `degree` entries below the
/// diagonal.
double operations_of(int degree) { return degree * (degree + 12.0); }

/// Minimum degree: the neighbours of each vertex that is eliminated are joined to each other.
class MinimumDegree {
 public:
  MinimumDegree(const SparseMatrix& pattern, const Followers& followers)
      : followers_(followers),
        neighbours_(pattern.cols()),
        height_(pattern.cols()),
        awaited_(pattern.cols()),
        position_(pattern.cols()) {
    for (int v = 0; v < pattern.cols(); ++v) {
      for (SparseMatrix::InnerIterator it(pattern, v); it; ++it) {
        if (it.index() != v) neighbours_[v].push_back(static_cast<int>(it.index()));
      }
      for (const int follower : followers[v]) ++awaited_[follower];
    }
  }

  /// Always takes one of the least degree of those that have none to wait for, among these one of
  /// the least height. Stops early above `limit` operations.
  void run(double limit) {
    const auto rank = [this](int v) { return std::array{degree(v), height_[v], v}; };
    std::set<std::array<int, 3>> ready;
    for (int v = 0; v < size(); ++v) {
      if (awaited_[v] == 0) ready.insert(rank(v));
    }
    for (int next = 0; next < size() && operations_ <= limit; ++next) {
      const int v = ready.begin()->back();
      ready.erase(ready.begin());
      position_[v] = next;
      for (const int u : neighbours_[v]) ready.erase(rank(u));
      join_neighbours(v);
      for (const int u : neighbours_[v]) {
        if (awaited_[u] == 0) ready.insert(rank(u));
      }
      for (const int u : followers_[v]) {
        if (--awaited_[u] == 0) ready.insert(rank(u));
      }
    }
  }

  [[nodiscard]] const std::vector<int>& position() const { return position_; }
  [[nodiscard]] double operations() const { return operations_; }

 private:
  [[nodiscard]] int degree(int v) const { return static_cast<int>(neighbours_[v].size()); }
  [[nodiscard]] int size() const { return static_cast<int>(position_.size()); }

  void join_neighbours(int v) {
    operations_ += operations_of(degree(v));
    for (const int u : neighbours_[v]) {
      joined_.clear();
      std::ranges::set_union(neighbours_[u], neighbours_[v], std::back_inserter(joined_));
      std::erase_if(joined_, [&](int w) { return w == u || w == v; });
      neighbours_[u].swap(joined_);
      height_[u] = std::max(height_[u], height_[v] + 1);
    }
  }

  const Followers& followers_;
  std::vector<std::vector<int>> neighbours_;  // sorted
  std::vector<int> height_;   // how many that are eliminated one after another are in front
  std::vector<int> awaited_;  // how many each still waits for
  std::vector<int> position_;
  std::vector<int> joined_;
  double operations_ = 0.0;
};

}  // namespace

std::vector<int> interleaved(const std::vector<int>& position, const Followers& followers) {
  const std::size_t unknowns = position.size();
  std::vector<int> awaited(followers.size()), result(followers.size()), order(unknowns);
  for (std::size_t v = 0; v < unknowns; ++v) order[position[v]] = static_cast<int>(v);
  for (const std::vector<int>& list : followers) {
    for (const int follower : list) ++awaited[follower];
  }
  int next = 0;
  for (std::size_t v = unknowns; v < followers.size(); ++v) {
    if (awaited[v] == 0) result[v] = next++;
  }
  for (const int v : order) {
    result[v] = next++;
    for (const int u : followers[v]) {
      if (--awaited[u] == 0) result[u] = next++;
    }
  }
  return result;
}

/// Each row of L is the union of paths in the elimination tree.
double operations(const SparseMatrix& pattern, const std::vector<int>& position) {
  std::vector<int> vertex(position.size()), parent(position.size(), -1), seen(position.size(), -1);
  std::vector<int> degree(position.size());
  for (std::size_t v = 0; v < position.size(); ++v) vertex[position[v]] = static_cast<int>(v);
  for (int row = 0; row < pattern.cols(); ++row) {
    seen[row] = row;
    for (SparseMatrix::InnerIterator it(pattern, vertex[row]); it; ++it) {
      for (int col = position[it.index()]; col < row && seen[col] != row; col = parent[col]) {
        if (parent[col] < 0) parent[col] = row;
        ++degree[col];
        seen[col] = row;
      }
    }
  }
  double sum = 0.0;
  for (const int entries : degree) sum += operations_of(entries);
  return sum;
}

std::vector<int> least_work(const SparseMatrix& saddle, const std::vector<int>& position,
                            const Followers& followers) {
  std::vector<int> result = interleaved(position, followers);
  const double limit = operations(saddle, result);
  MinimumDegree by_degree(saddle, followers);
  by_degree.run(limit);
  return by_degree.operations() < limit ? by_degree.position() : result;
}

std::vector<int> in_place(int size) {
  std::vector<int> identity(size);
  std::iota(identity.begin(), identity.end(), 0);
  return identity;
}

SparseMatrix dominant(const SparseMatrix& pattern, const std::vector<int>& position) {
  std::vector<Eigen::Triplet<double>> entries;
  for (int col = 0; col < pattern.cols(); ++col) {
    for (SparseMatrix::InnerIterator it(pattern, col); it; ++it) {
      const double value = it.row() == col ? static_cast<double>(pattern.cols()) : 1.0;
      entries.emplace_back(position[it.row()], position[col], value);
    }
  }
  SparseMatrix matrix(pattern.rows(), pattern.cols());
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

}  // namespace mbs::eigen_sparse
