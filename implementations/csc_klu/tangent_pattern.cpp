// The union pattern of M and Phi_q^T Phi_q and the schedule of the rank-k update, found once.
#include "tangent_pattern.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

namespace mbs::csc_klu {
namespace {

/// Every pair of free points that share a constraint, once per shared constraint.
struct Pair {
  int p, q;         ///< p < q
  int left, right;  ///< their Jacobian blocks
};

template <int dim>
std::vector<Pair> point_pairs(const JacobianPattern<dim>& jacobian) {
  std::vector<std::vector<std::pair<int, int>>> row_blocks(jacobian.dots());
  for (int p = 0; p < jacobian.points(); ++p) {
    for (int k = jacobian.block_begin[p]; k < jacobian.block_begin[p + 1]; ++k) {
      row_blocks[jacobian.block_row[k]].push_back({p, k});
    }
  }
  std::vector<Pair> pairs;
  for (const auto& blocks : row_blocks) {
    for (std::size_t i = 0; i < blocks.size(); ++i) {
      for (std::size_t j = i + 1; j < blocks.size(); ++j) {
        pairs.push_back({blocks[i].first, blocks[j].first, blocks[i].second, blocks[j].second});
      }
    }
  }
  std::ranges::stable_sort(pairs, {}, [](const Pair& pair) { return std::tuple(pair.p, pair.q); });
  return pairs;
}

/// Calls visit(row, col, product) for every product in Phi_q^T Phi_q of the linear constraints.
template <int dim, class Visit>
void visit_linear(const JacobianPattern<dim>& jacobian, Visit visit) {
  int begin = 0;
  for (const auto& linear : jacobian.linears) {
    for (int s = begin; s < linear.terms_end; ++s) {
      for (int t = begin; t < linear.terms_end; ++t) {
        const auto &row = jacobian.linear_terms[s], &col = jacobian.linear_terms[t];
        visit(row.coordinate, col.coordinate, row.coefficient * col.coefficient);
      }
    }
    begin = linear.terms_end;
  }
}

/// Offsets of the first rows of the columns of block (p, q).
template <int dim>
std::array<int, dim> block_columns(const Pattern& pattern, int p, int q) {
  std::array<int, dim> columns;
  for (int k = 0; k < dim; ++k) columns[k] = pattern.offset(dim * p, dim * q + k);
  return columns;
}

}  // namespace

template <int dim>
TangentPattern<dim>::TangentPattern(const Model& model, const JacobianPattern<dim>& jacobian) {
  const std::vector<Pair> pairs = point_pairs(jacobian);
  const auto is_constrained = [&](int p) {
    return jacobian.block_begin[p] < jacobian.block_begin[p + 1];
  };
  std::vector<Pattern::Position> positions = mass_positions(model);
  const auto add_block = [&](int p, int q) {
    for (int col = dim * q; col < dim * q + dim; ++col) {
      for (int row = dim * p; row < dim * p + dim; ++row) positions.push_back({row, col});
    }
  };
  for (int p = 0; p < jacobian.points(); ++p) {
    if (is_constrained(p)) add_block(p, p);
  }
  for (const Pair& pair : pairs) {
    add_block(pair.p, pair.q);
    add_block(pair.q, pair.p);
  }
  visit_linear(jacobian, [&](int row, int col, double) { positions.push_back({row, col}); });
  pattern = Pattern(model.variables(), std::move(positions));

  for (int p = 0; p < jacobian.points(); ++p) {
    if (!is_constrained(p)) continue;
    diagonals.push_back(
        {jacobian.block_begin[p], jacobian.block_begin[p + 1], block_columns<dim>(pattern, p, p)});
  }
  const Pair* last = nullptr;
  for (const Pair& pair : pairs) {
    const bool repeated = last != nullptr && last->p == pair.p && last->q == pair.q;
    (repeated ? further_couplings : couplings)
        .push_back({pair.left, pair.right, block_columns<dim>(pattern, pair.p, pair.q),
                    block_columns<dim>(pattern, pair.q, pair.p)});
    last = &pair;
  }
  visit_linear(jacobian, [&](int row, int col, double product) {
    constants.push_back({pattern.offset(row, col), product});
  });
}

template struct TangentPattern<2>;
template struct TangentPattern<3>;

}  // namespace mbs::csc_klu
