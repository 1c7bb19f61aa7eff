// Elimination order for the simplicial factorization: AMD's fill, few dependent steps in a row.
#include <algorithm>
#include <numeric>

#include "saddle_order.hpp"

namespace mbs::eigen_sparse {
namespace {

/// The filled graph of a factor L (columns in elimination order, no diagonal), shrinking while
/// vertices are eliminated again in another order that adds no fill.
class FilledGraph {
 public:
  explicit FilledGraph(const SparseMatrix& L)
      : neighbours_(L + SparseMatrix(L.transpose())),
        first_(neighbours_.outerIndexPtr(), neighbours_.outerIndexPtr() + L.cols()),
        position_(L.cols(), -1) {
    for (int v = 0; v < L.cols(); ++v) {
      degree_.push_back(neighbours_.outerIndexPtr()[v + 1] - first_[v]);
      later_.push_back(L.outerIndexPtr()[v + 1] - L.outerIndexPtr()[v]);
    }
  }

  /// Whether the neighbours of `v` that are left are joined to each other. Those of a vertex that
  /// follow it in L are: so it is enough to count them at the first vertex among `v` and these.
  bool is_simplicial(int v) {
    const int* rows = neighbours_.innerIndexPtr();
    const int end = neighbours_.outerIndexPtr()[v + 1];
    while (first_[v] < end && position_[rows[first_[v]]] >= 0) ++first_[v];
    const int first = first_[v] < end ? std::min(v, rows[first_[v]]) : v;
    return degree_[v] == later_[first];
  }

  /// Takes `v` out; `visit` gets each neighbour that is left.
  template <class Visit>
  void eliminate(int v, Visit visit) {
    position_[v] = eliminated_++;
    for (SparseMatrix::InnerIterator it(neighbours_, v); it; ++it) {
      const auto u = static_cast<int>(it.index());
      if (position_[u] >= 0) continue;
      --degree_[u];
      if (u < v) --later_[u];
      visit(u);
    }
  }

  [[nodiscard]] const std::vector<int>& positions() const { return position_; }

 private:
  SparseMatrix neighbours_;
  std::vector<int> first_;           // where a vertex's neighbours that may be left begin
  std::vector<int> position_;        // in the new order; -1: left
  std::vector<int> degree_, later_;  // neighbours left: all, those behind the vertex in L
  int eliminated_ = 0;
};

/// Rounds of Jess and Kees: each eliminates as many independent vertices as it can without fill,
/// followers after those that they follow.
std::vector<int> positions_by_rounds(const SparseMatrix& L, const Followers& followers) {
  FilledGraph graph(L);
  std::vector<int> candidates(L.cols()), next, touched(L.cols(), -1), awaited(L.cols());
  std::iota(candidates.begin(), candidates.end(), 0);
  for (const std::vector<int>& list : followers) {
    for (const int follower : list) ++awaited[follower];
  }
  for (int round = 0; !candidates.empty(); ++round) {
    const auto touch = [&](int u) {
      if (touched[u] != round) next.push_back(u);
      touched[u] = round;
    };
    for (const int v : candidates) {
      if (touched[v] == round || awaited[v] > 0 || !graph.is_simplicial(v)) continue;
      graph.eliminate(v, touch);
      for (const int follower : followers[v]) {
        if (--awaited[follower] == 0) touch(follower);
      }
    }
    candidates.swap(next);
    next.clear();
  }
  return graph.positions();
}

/// `followers` where `place` puts them.
Followers placed(const Followers& followers, const std::vector<int>& place) {
  Followers result(followers.size());
  for (std::size_t i = 0; i < place.size(); ++i) {
    for (const int follower : followers[i]) result[place[i]].push_back(place[follower]);
  }
  return result;
}

}  // namespace

template <class Scalar>
std::vector<int> SimplicialSolver<Scalar>::elimination_order(const SparseMatrix& pattern,
                                                             Tuning tuning) {
  const Eigen::SimplicialLDLT<SparseMatrix, Eigen::Upper> factors(
      dominant(pattern, in_place(static_cast<int>(pattern.cols()))));  // AMD
  const auto& amd = factors.permutationP().indices();
  std::vector<int> position(amd.begin(), amd.end());
  if (tuning == Tuning::amd) return position;
  const std::vector<int> rounds =
      positions_by_rounds(factors.matrixL().nestedExpression(), Followers(pattern.cols()));
  for (int& place : position) place = rounds[place];
  return position;
}

template <class Scalar>
std::vector<int> SimplicialSolver<Scalar>::saddle_order(const SparseMatrix& saddle,
                                                        const Followers& followers, const Model&,
                                                        const Coordinates& coordinates,
                                                        Tuning tuning) {
  std::vector<int> position = in_place(coordinates.variables());
  if (tuning == Tuning::amd) return interleaved(position, followers);
  position = least_work(saddle, position, followers);
  using InPlace = Eigen::SimplicialLDLT<SparseMatrix, Eigen::Upper, Eigen::NaturalOrdering<int>>;
  const InPlace factors(dominant(saddle, position));
  const std::vector<int> rounds =
      positions_by_rounds(factors.matrixL().nestedExpression(), placed(followers, position));
  for (int& place : position) place = rounds[place];
  return position;
}

template std::vector<int> SimplicialSolver<double>::elimination_order(const SparseMatrix&, Tuning);
template std::vector<int> SimplicialSolver<double>::saddle_order(const SparseMatrix&,
                                                                 const Followers&, const Model&,
                                                                 const Coordinates&, Tuning);
template std::vector<int> SimplicialSolver<float>::elimination_order(const SparseMatrix&, Tuning);
template std::vector<int> SimplicialSolver<float>::saddle_order(const SparseMatrix&,
                                                                const Followers&, const Model&,
                                                                const Coordinates&, Tuning);

}  // namespace mbs::eigen_sparse
