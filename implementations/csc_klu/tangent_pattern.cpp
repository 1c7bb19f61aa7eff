// The union pattern of T and the schedules that update it, found once.
#include "tangent_pattern.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

#include "element_blocks.hpp"

namespace mbs::csc_klu {
namespace {

/// Every pair of free points that share a constraint, once per shared constraint.
struct Pair {
  int p, q;         ///< p < q
  int left, right;  ///< their Jacobian blocks
};

std::pair<int, int> points_of(const Pair& pair) { return {pair.p, pair.q}; }

template <int dim>
std::vector<Pair> point_pairs(const JacobianPattern<dim>& jacobian) {
  std::vector<std::vector<std::pair<int, int>>> row_blocks(jacobian.quadratics());
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
  std::ranges::stable_sort(pairs, {}, points_of);
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

template <int dim>
bool is_constrained(const JacobianPattern<dim>& jacobian, int p) {
  return jacobian.block_begin[p] < jacobian.block_begin[p + 1];
}

/// Whether constraints write block (p, q) in every pass; `pairs` are sorted.
template <int dim>
bool is_written(const JacobianPattern<dim>& jacobian, const std::vector<Pair>& pairs, int p,
                int q) {
  if (p == q) return is_constrained(jacobian, p);
  const std::pair<int, int> points = std::minmax(p, q);
  const auto found = std::ranges::lower_bound(pairs, points, {}, points_of);
  return found != pairs.end() && points_of(*found) == points;
}

template <int dim>
Pattern union_pattern(const Model& model, const JacobianPattern<dim>& jacobian,
                      const std::vector<Pair>& pairs, const std::vector<ElementBlock>& elements) {
  std::vector<Pattern::Position> positions = mass_positions(model);
  const auto add_block = [&](int p, int q) {
    for (int col = dim * q; col < dim * q + dim; ++col) {
      for (int row = dim * p; row < dim * p + dim; ++row) positions.push_back({row, col});
    }
  };
  for (int p = 0; p < jacobian.points(); ++p) {
    if (is_constrained(jacobian, p)) add_block(p, p);
  }
  for (const Pair& pair : pairs) {
    add_block(pair.p, pair.q);
    add_block(pair.q, pair.p);
  }
  for (const ElementBlock& block : elements) add_block(block.p, block.q);
  visit_linear(jacobian, [&](int row, int col, double) { positions.push_back({row, col}); });
  return Pattern(model.variables(), std::move(positions));
}

}  // namespace

template <int dim>
TangentPattern<dim>::TangentPattern(const Model& model, const JacobianPattern<dim>& jacobian,
                                    const ForcePattern& forces, Order elimination) {
  const std::vector<Pair> pairs = point_pairs(jacobian);
  const std::vector<ElementBlock> elements = element_blocks(forces, dim);
  pattern = union_pattern(model, jacobian, pairs, elements);
  order = ordered(pattern, elimination);
  const auto columns = [&](int p, int q) {
    Columns offsets;
    for (int k = 0; k < dim; ++k) offsets[k] = pattern.offset(dim * p, dim * q + k);
    return offsets;
  };
  for (int p = 0; p < jacobian.points(); ++p) {
    if (!is_constrained(jacobian, p)) continue;
    diagonals.push_back({jacobian.block_begin[p], jacobian.block_begin[p + 1], columns(p, p)});
  }
  const Pair* last = nullptr;
  for (const Pair& pair : pairs) {
    const bool repeated = last != nullptr && points_of(*last) == points_of(pair);
    (repeated ? further_couplings : couplings)
        .push_back({pair.left, pair.right, columns(pair.p, pair.q), columns(pair.q, pair.p)});
    last = &pair;
  }
  visit_linear(jacobian, [&](int row, int col, double product) {
    constants.push_back({pattern.offset(row, col), product});
  });
  shares = ElementShares<dim>(elements, pattern,
                              [&](int p, int q) { return is_written(jacobian, pairs, p, q); });
}

template struct TangentPattern<2>;
template struct TangentPattern<3>;

}  // namespace mbs::csc_klu
