// Elimination order for the simplicial factorization: AMD's fill, few dependent steps in a row.
#include <algorithm>
#include <numeric>

#include "solver.hpp"

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

/// A matrix of this pattern that has factors.
SparseMatrix dominant(const SparseMatrix& pattern) {
  SparseMatrix matrix = pattern;
  matrix.coeffs().setOnes();
  matrix.diagonal().setConstant(static_cast<double>(pattern.cols()));
  return matrix;
}

}  // namespace

template <class Scalar, Tuning kTuning>
std::vector<int> TunedSimplicial<Scalar, kTuning>::elimination_order(const SparseMatrix& pattern) {
  const Eigen::SimplicialLDLT<SparseMatrix, Eigen::Upper> factors(dominant(pattern));  // AMD
  const auto& amd = factors.permutationP().indices();
  if (kTuning == Tuning::amd) return {amd.begin(), amd.end()};
  const std::vector<int> positions =
      positions_by_rounds(factors.matrixL().nestedExpression(), Followers(pattern.cols()));
  std::vector<int> position(pattern.cols());
  for (int i = 0; i < pattern.cols(); ++i) position[i] = positions[amd[i]];
  return position;
}

template <class Scalar, Tuning kTuning>
std::vector<int> TunedSimplicial<Scalar, kTuning>::equivalent_order(const SparseMatrix& pattern,
                                                                    const Followers& followers) {
  using InPlace = Eigen::SimplicialLDLT<SparseMatrix, Eigen::Upper, Eigen::NaturalOrdering<int>>;
  const InPlace factors(dominant(pattern));
  return positions_by_rounds(factors.matrixL().nestedExpression(), followers);
}

template std::vector<int> TunedSimplicial<double, Tuning::own>::elimination_order(
    const SparseMatrix&);
template std::vector<int> TunedSimplicial<double, Tuning::amd>::elimination_order(
    const SparseMatrix&);
template std::vector<int> TunedSimplicial<double, Tuning::own>::equivalent_order(
    const SparseMatrix&, const Followers&);
template std::vector<int> TunedSimplicial<double, Tuning::amd>::equivalent_order(
    const SparseMatrix&, const Followers&);
template std::vector<int> TunedSimplicial<float, Tuning::own>::elimination_order(
    const SparseMatrix&);
template std::vector<int> TunedSimplicial<float, Tuning::own>::equivalent_order(const SparseMatrix&,
                                                                                const Followers&);

}  // namespace mbs::eigen_sparse
