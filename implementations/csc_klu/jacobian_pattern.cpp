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

/// Offsets of all points in the extended vector.
std::vector<int> extended_offsets(const Model& model) {
  std::vector<int> offsets;
  int fixed = model.variables();
  for (const Point& point : model.points()) {
    offsets.push_back(point.is_fixed() ? fixed : point.offset);
    if (point.is_fixed()) fixed += model.dimension();
  }
  return offsets;
}

/// A block of Phi_q: its constraint, its free point, the signs of JacobianPattern::Term and,
/// once all blocks are known, its place.
struct Draft {
  int row, point;
  double first, second;
  int block = -1;
};

/// Appends the blocks of one dot constraint: its free points, each once.
template <int dim>
void append_drafts(const Model& model, const DotConstraint& dot, int row,
                   std::vector<Draft>& drafts) {
  const auto add = [&, start = drafts.size()](int index, double first, double second) {
    const Point& point = model.points()[index];
    if (point.is_fixed()) return;
    for (std::size_t k = start; k < drafts.size(); ++k) {
      if (drafts[k].point != point.offset / dim) continue;
      drafts[k].first += first;
      drafts[k].second += second;
      return;
    }
    drafts.push_back({row, point.offset / dim, first, second});
  };
  add(dot.a, 1.0, 0.0);
  add(dot.b, -1.0, 0.0);
  add(dot.c, 0.0, 1.0);
  add(dot.d, 0.0, -1.0);
}

/// Gives every draft its place: sorted by point, for a point in the order of constraints.
/// `block_begin` arrives as zeros, points + 1 of them.
void place_blocks(std::vector<Draft>& drafts, std::vector<int>& block_begin,
                  std::vector<int>& block_row) {
  for (const Draft& draft : drafts) ++block_begin[draft.point + 1];
  std::partial_sum(block_begin.begin(), block_begin.end(), block_begin.begin());
  std::vector<int> next = block_begin;
  block_row.resize(drafts.size());
  for (Draft& draft : drafts) {
    draft.block = next[draft.point]++;
    block_row[draft.block] = draft.row;
  }
}

}  // namespace

template <int dim>
JacobianPattern<dim>::JacobianPattern(const Model& model)
    : model_row(distances_first(model)), block_begin(model.variables() / dim + 1, 0) {
  for (const Point& point : model.points()) {
    if (!point.is_fixed()) continue;
    const auto begin = point.position.begin();
    fixed_coordinates.insert(fixed_coordinates.end(), begin, begin + dim);
  }
  const std::span<const DotConstraint> dots = model.dot_constraints();
  std::vector<Draft> drafts;
  for (int i = 0; i < std::ssize(dots); ++i) {
    append_drafts<dim>(model, dots[model_row[i]], i, drafts);
  }
  place_blocks(drafts, block_begin, block_row);
  const std::vector<int> offset = extended_offsets(model);
  auto draft = drafts.begin();
  for (int i = 0; i < std::ssize(dots); ++i) {
    const DotConstraint& dot = dots[model_row[i]];
    const int a = offset[dot.a], b = offset[dot.b], c = offset[dot.c], d = offset[dot.d];
    if (is_distance(dot)) {
      distances.push_back({a, b, blocks(), blocks(), dot.value});
      Distance& distance = distances.back();
      for (; draft != drafts.end() && draft->row == i; ++draft) {
        (draft->first > 0.0 ? distance.block_a : distance.block_b) = draft->block;
      }
    } else {
      for (; draft != drafts.end() && draft->row == i; ++draft) {
        other_terms.push_back({draft->block, draft->first, draft->second});
      }
      others.push_back({a, b, c, d, dot.value, static_cast<int>(other_terms.size())});
    }
  }
  for (const LinearConstraint& constraint : model.linear_constraints()) {
    linear_terms.insert(linear_terms.end(), constraint.terms.begin(), constraint.terms.end());
    linears.push_back({constraint.value, static_cast<int>(linear_terms.size())});
  }
}

template struct JacobianPattern<2>;
template struct JacobianPattern<3>;

}  // namespace mbs::csc_klu
