// Where everything in Phi and Phi_q is stored, found once from the model.
#include "jacobian_pattern.hpp"

#include <algorithm>
#include <numeric>
#include <span>

namespace mbs::csc_klu {
namespace {

bool is_distance(const DotConstraint& dot) {
  return dot.a == dot.c && dot.b == dot.d && dot.a != dot.b;
}

/// The model's constraints in the order of JacobianPattern.
std::vector<int> distances_first(const Model& model) {
  std::vector<int> order(model.constraints());
  std::iota(order.begin(), order.end(), 0);
  const std::span<const DotConstraint> dots = model.dot_constraints();
  std::stable_partition(order.begin(), order.begin() + std::ssize(dots),
                        [&](int i) { return is_distance(dots[i]); });
  return order;
}

/// Values of all constraints in the model's order, zero where they are functions of time.
std::vector<double> constant_values(const Model& model) {
  std::vector<double> values;
  for (const DotConstraint& dot : model.dot_constraints()) values.push_back(dot.value);
  for (const BilinearConstraint& bilinear : model.bilinear_constraints()) {
    values.push_back(bilinear.value);
  }
  for (const LinearConstraint& linear : model.linear_constraints()) values.push_back(linear.value);
  for (const DrivenValue& driven : model.driven_values()) values[driven.constraint] = 0.0;
  return values;
}

/// A block of Phi_q: its constraint, its free point and, once all blocks are known, its place.
struct Draft {
  int row;
  MovedPoint moved;
  int block = -1;
};

/// The blocks of all quadratic constraints, one constraint after the other.
template <class Constraints>
void append_drafts(const Model& model, const Constraints& constraints, const int* order, int row,
                   std::vector<Draft>& drafts) {
  std::vector<MovedPoint> moved;
  for (int i = 0; i < std::ssize(constraints); ++i) {
    const auto& constraint = constraints[order[i] - row];
    moved.clear();
    append_moved_points(model, {constraint.a, constraint.b, constraint.c, constraint.d}, moved);
    for (const MovedPoint& point : moved) drafts.push_back({row + i, point});
  }
}

/// Gives every draft its place: sorted by point, for a point in the order of constraints.
/// `block_begin` arrives as zeros, points + 1 of them.
void place_blocks(int dim, std::vector<Draft>& drafts, std::vector<int>& block_begin,
                  std::vector<int>& block_row) {
  for (const Draft& draft : drafts) ++block_begin[draft.moved.coordinate / dim + 1];
  std::partial_sum(block_begin.begin(), block_begin.end(), block_begin.begin());
  std::vector<int> next = block_begin;
  block_row.resize(drafts.size());
  for (Draft& draft : drafts) {
    draft.block = next[draft.moved.coordinate / dim]++;
    block_row[draft.block] = draft.row;
  }
}

/// Everything that lowering one constraint after the other needs.
struct Lowering {
  const Model& model;
  const std::vector<int> offset = extended_offsets(model);
  const std::vector<double> value = constant_values(model);
  std::vector<Draft>::const_iterator draft, end;  ///< those not yet lowered

  /// Appends the blocks of constraint `row` as terms; their number so far.
  template <class Term>
  int append_terms(int row, std::vector<Term>& terms) {
    for (; draft != end && draft->row == row; ++draft) {
      terms.push_back({draft->block, draft->moved.first, draft->moved.second});
    }
    return static_cast<int>(terms.size());
  }
};

template <int dim>
void lower_dots(Lowering& lowering, JacobianPattern<dim>& pattern) {
  const std::span<const DotConstraint> dots = lowering.model.dot_constraints();
  const std::vector<int>& offset = lowering.offset;
  auto& draft = lowering.draft;
  for (int i = 0; i < std::ssize(dots); ++i) {
    const int row = pattern.model_row[i];
    const DotConstraint& dot = dots[row];
    const int a = offset[dot.a], b = offset[dot.b], c = offset[dot.c], d = offset[dot.d];
    const double value = lowering.value[row];
    if (is_distance(dot)) {
      pattern.distances.push_back({a, b, pattern.blocks(), pattern.blocks(), value});
      auto& distance = pattern.distances.back();
      for (; draft != lowering.end && draft->row == i; ++draft) {
        (draft->moved.first > 0.0 ? distance.block_a : distance.block_b) = draft->block;
      }
    } else {
      pattern.dots.push_back({a, b, c, d, value, lowering.append_terms(i, pattern.terms)});
    }
  }
}

template <int dim>
void lower_bilinears(Lowering& lowering, JacobianPattern<dim>& pattern) {
  const std::vector<int>& offset = lowering.offset;
  int row = static_cast<int>(std::ssize(lowering.model.dot_constraints()));
  for (const BilinearConstraint& bilinear : lowering.model.bilinear_constraints()) {
    const int terms_end = lowering.append_terms(row, pattern.terms);
    pattern.bilinears.push_back({offset[bilinear.a], offset[bilinear.b], offset[bilinear.c],
                                 offset[bilinear.d], lowering.value[row], terms_end,
                                 small_matrix<dim>(bilinear.B)});
    ++row;
  }
}

}  // namespace

template <int dim>
JacobianPattern<dim>::JacobianPattern(const Model& model)
    : model_row(distances_first(model)), block_begin(model.variables() / dim + 1, 0) {
  const int dot_count = static_cast<int>(std::ssize(model.dot_constraints()));
  const int* const order = model_row.data();
  std::vector<Draft> drafts;
  append_drafts(model, model.dot_constraints(), order, 0, drafts);
  append_drafts(model, model.bilinear_constraints(), order + dot_count, dot_count, drafts);
  place_blocks(dim, drafts, block_begin, block_row);

  Lowering lowering{.model = model, .draft = drafts.cbegin(), .end = drafts.cend()};
  lower_dots(lowering, *this);
  lower_bilinears(lowering, *this);
  int row = quadratics();
  for (const LinearConstraint& constraint : model.linear_constraints()) {
    linear_terms.insert(linear_terms.end(), constraint.terms.begin(), constraint.terms.end());
    linears.push_back({lowering.value[row++], static_cast<int>(linear_terms.size())});
  }
}

template struct JacobianPattern<2>;
template struct JacobianPattern<3>;

}  // namespace mbs::csc_klu
