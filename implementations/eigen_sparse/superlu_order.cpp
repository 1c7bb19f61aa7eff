// Elimination orders for SuperLU, and its options.
#include <metis.h>

#include <array>
#include <limits>
#include <utility>

#include "mbs/simulation.hpp"
#include "saddle_order.hpp"
#include "superlu_calls.hpp"

namespace mbs::eigen_sparse {
namespace {

/// Orders to choose from; README.md has what others gain.
constexpr std::array kCandidates{Tuning::mmd, Tuning::amd, Tuning::model};
/// With so many times the operations of another one an order needs no trial.
constexpr double kHopeless = 3.0;

NCformat columns_of(const SparseMatrix& matrix) {
  return {static_cast<int>(matrix.nonZeros()), const_cast<double*>(matrix.valuePtr()),
          const_cast<int*>(matrix.innerIndexPtr()), const_cast<int*>(matrix.outerIndexPtr())};
}

/// `perm_c` followed by a postorder of the column elimination tree that it gives.
std::vector<int> postordered(const SparseMatrix& pattern, std::vector<int> perm_c) {
  NCformat columns = columns_of(pattern);
  SuperMatrix view = described(SLU_NC, pattern, &columns), ordered{};
  superlu_options_t options = options_for_diagonal_pivots();
  std::vector<int> etree(pattern.cols());
  sp_preorder(&options, &view, perm_c.data(), etree.data(), &ordered);
  Destroy_CompCol_Permuted(&ordered);
  return perm_c;
}

std::vector<int> by_superlu(const SparseMatrix& pattern, colperm_t order) {
  NCformat columns = columns_of(pattern);
  SuperMatrix view = described(SLU_NC, pattern, &columns);
  std::vector<int> position(pattern.cols());
  get_perm_c(order, &view, position.data());
  return position;
}

std::vector<int> by_metis(const SparseMatrix& pattern) {
  std::vector<idx_t> starts{0}, rows, order(pattern.cols()), position(pattern.cols());
  for (int col = 0; col < pattern.cols(); ++col) {
    for (SparseMatrix::InnerIterator it(pattern, col); it; ++it) {
      if (it.row() != col) rows.push_back(static_cast<idx_t>(it.row()));
    }
    starts.push_back(static_cast<idx_t>(rows.size()));
  }
  idx_t size = static_cast<idx_t>(pattern.cols());
  if (METIS_NodeND(&size, starts.data(), rows.data(), nullptr, nullptr, order.data(),
                   position.data()) != METIS_OK) {
    throw Unsupported("METIS cannot order the matrix");
  }
  return {position.begin(), position.end()};
}

std::vector<int> position_by(Tuning order, const SparseMatrix& pattern) {
  switch (order) {
    case Tuning::model:
      return in_place(static_cast<int>(pattern.cols()));
    case Tuning::amd:
      return SimplicialSolver<double>::elimination_order(pattern, Tuning::amd);
    case Tuning::trees:
      return SimplicialSolver<double>::elimination_order(pattern, Tuning::own);
    case Tuning::metis:
      return by_metis(pattern);
    default:
      return by_superlu(pattern, order == Tuning::colamd ? COLAMD : MMD_AT_PLUS_A);
  }
}

/// `order`(tuning) gives positions in `pattern`. Returns those as tuned, or of the candidates those
/// with the cheapest trial factorization; postordered.
template <class Order>
std::vector<int> chosen(const SparseMatrix& pattern, Tuning tuning, Order order) {
  if (tuning != Tuning::own && tuning != Tuning::panels) return postordered(pattern, order(tuning));
  std::vector<int> best;
  double fewest = std::numeric_limits<double>::infinity(), least = fewest;
  for (const Tuning candidate : kCandidates) {
    std::vector<int> position = postordered(pattern, order(candidate));
    const double count = operations(pattern, position);
    fewest = std::min(fewest, count);
    if (count > kHopeless * fewest) continue;
    const SparseMatrix matrix = dominant(pattern, position);
    const double cost = SuperluSolver<double>(matrix, Definiteness::positive, Tuning::own).cost();
    if (cost >= least && !best.empty()) continue;
    least = cost;
    best = std::move(position);
  }
  return best;
}

}  // namespace

superlu_options_t options_for_diagonal_pivots() {
  superlu_options_t options;
  set_default_options(&options);
  options.ColPerm = MMD_AT_PLUS_A;
  options.DiagPivotThresh = 0.0;  // the diagonal, unless it is exactly zero
  options.PrintStat = NO;
  return options;
}

template <class Scalar>
std::vector<int> SuperluSolver<Scalar>::elimination_order(const SparseMatrix& pattern,
                                                          Tuning tuning) {
  return chosen(pattern, tuning, [&](Tuning order) { return position_by(order, pattern); });
}

template <class Scalar>
std::vector<int> SuperluSolver<Scalar>::saddle_order(const SparseMatrix& saddle,
                                                     const Followers& followers, const Model& model,
                                                     const Coordinates& coordinates,
                                                     Tuning tuning) {
  const int n = model.variables();
  const SparseMatrix tangent = tangent_pattern(model, {model, in_place(n)});
  return chosen(saddle, tuning, [&](Tuning order) {
    const std::vector<int> of_model = postordered(tangent, position_by(order, tangent));
    std::vector<int> position(n);
    for (int i = 0; i < n; ++i) position[coordinates.of_unknown(i)] = of_model[i];
    return interleaved(position, followers);
  });
}

std::string superlu_version() {
  return std::to_string(SUPERLU_MAJOR_VERSION) + "." + std::to_string(SUPERLU_MINOR_VERSION) + "." +
         std::to_string(SUPERLU_PATCH_VERSION);
}

template std::vector<int> SuperluSolver<double>::elimination_order(const SparseMatrix&, Tuning);
template std::vector<int> SuperluSolver<double>::saddle_order(const SparseMatrix&, const Followers&,
                                                              const Model&, const Coordinates&,
                                                              Tuning);
template std::vector<int> SuperluSolver<float>::elimination_order(const SparseMatrix&, Tuning);
template std::vector<int> SuperluSolver<float>::saddle_order(const SparseMatrix&, const Followers&,
                                                             const Model&, const Coordinates&,
                                                             Tuning);

}  // namespace mbs::eigen_sparse
