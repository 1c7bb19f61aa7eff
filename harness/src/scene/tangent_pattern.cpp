// Two compressed lists, coordinates by clique and cliques by coordinate, give the pattern on the
// fly.
#include "scene/tangent_pattern.hpp"

#include <algorithm>

namespace mbs {
namespace {

/// Turns counts, kept one place ahead, into starts.
void accumulate(std::vector<std::size_t>& counts) {
  for (std::size_t i = 1; i < counts.size(); ++i) counts[i] += counts[i - 1];
}

}  // namespace

TangentPattern::TangentPattern(const Model& model, PatternOf which)
    : mass_(model.mass()),
      mass_start_(static_cast<std::size_t>(model.variables()) + 1, 0),
      clique_start_{0},
      column_start_(static_cast<std::size_t>(model.variables()) + 1, 0),
      seen_in_(static_cast<std::size_t>(model.variables()), -1) {
  for (const MassEntry& entry : mass_) ++mass_start_[static_cast<std::size_t>(entry.col) + 1];
  accumulate(mass_start_);
  if (which == PatternOf::tangent) read_constraints(model);
  read_forces(model);
  for (const int col : clique_columns_) ++column_start_[static_cast<std::size_t>(col) + 1];
  accumulate(column_start_);
  column_cliques_.resize(clique_columns_.size());
  std::vector<std::size_t> next(column_start_.begin(), column_start_.end() - 1);
  for (std::size_t i = 0; i + 1 < clique_start_.size(); ++i) {
    for (std::size_t k = clique_start_[i]; k < clique_start_[i + 1]; ++k) {
      column_cliques_[next[static_cast<std::size_t>(clique_columns_[k])]++] = static_cast<int>(i);
    }
  }
}

void TangentPattern::add_points(const Model& model, std::initializer_list<int> points) {
  const auto first = static_cast<std::ptrdiff_t>(clique_columns_.size());
  for (const int index : points) {
    const Point& point = model.points()[static_cast<std::size_t>(index)];
    const auto begin = clique_columns_.begin() + first;
    if (point.is_fixed() ||
        std::find(begin, clique_columns_.end(), point.offset) != clique_columns_.end()) {
      continue;
    }
    for (int axis = 0; axis < model.dimension(); ++axis) {
      clique_columns_.push_back(point.offset + axis);
    }
  }
  clique_start_.push_back(clique_columns_.size());
}

void TangentPattern::read_constraints(const Model& model) {
  for (const DotConstraint& c : model.dot_constraints()) add_points(model, {c.a, c.b, c.c, c.d});
  for (const BilinearConstraint& c : model.bilinear_constraints()) {
    add_points(model, {c.a, c.b, c.c, c.d});
  }
  for (const LinearConstraint& constraint : model.linear_constraints()) {
    for (const auto& term : constraint.terms) clique_columns_.push_back(term.coordinate);
    clique_start_.push_back(clique_columns_.size());
  }
}

void TangentPattern::read_forces(const Model& model) {
  for (const Spring& spring : model.springs()) add_points(model, {spring.a, spring.b});
  for (const TorsionSpring& spring : model.torsion_springs()) {
    add_points(model, {spring.a, spring.b, spring.c, spring.d});
  }
  for (const ForceLaw& law : model.force_laws()) add_points(model, {law.a, law.b});
  for (const TorqueLaw& law : model.torque_laws()) {
    add_points(model, {law.a, law.b, law.c, law.d});
  }
}

void TangentPattern::collect(int col, int row) {
  int& seen_in = seen_in_[static_cast<std::size_t>(row)];
  if (row <= col || seen_in == col) return;
  seen_in = col;
  rows_.push_back(row);
}

std::span<const int> TangentPattern::below(int col) {
  // Forget the last call: the same column may be asked for twice.
  for (const int row : rows_) seen_in_[static_cast<std::size_t>(row)] = -1;
  rows_.clear();
  const auto j = static_cast<std::size_t>(col);
  for (std::size_t k = mass_start_[j]; k < mass_start_[j + 1]; ++k) collect(col, mass_[k].row);
  for (std::size_t k = column_start_[j]; k < column_start_[j + 1]; ++k) {
    const auto i = static_cast<std::size_t>(column_cliques_[k]);
    for (std::size_t p = clique_start_[i]; p < clique_start_[i + 1]; ++p) {
      collect(col, clique_columns_[p]);
    }
  }
  return rows_;
}

}  // namespace mbs
