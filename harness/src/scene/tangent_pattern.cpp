// Two compressed patterns, Phi_q by rows and by columns, give Phi_q^T Phi_q on the fly.
#include "scene/tangent_pattern.hpp"

#include <algorithm>

namespace mbs {
namespace {

/// Turns counts, kept one place ahead, into starts.
void accumulate(std::vector<std::size_t>& counts) {
  for (std::size_t i = 1; i < counts.size(); ++i) counts[i] += counts[i - 1];
}

}  // namespace

TangentPattern::TangentPattern(const Model& model)
    : mass_(model.mass()),
      mass_start_(static_cast<std::size_t>(model.variables()) + 1, 0),
      constraint_start_{0},
      column_start_(static_cast<std::size_t>(model.variables()) + 1, 0),
      seen_in_(static_cast<std::size_t>(model.variables()), -1) {
  for (const MassEntry& entry : mass_) ++mass_start_[static_cast<std::size_t>(entry.col) + 1];
  accumulate(mass_start_);
  read_constraints(model);
  for (const int col : constraint_columns_) ++column_start_[static_cast<std::size_t>(col) + 1];
  accumulate(column_start_);
  column_constraints_.resize(constraint_columns_.size());
  std::vector<std::size_t> next(column_start_.begin(), column_start_.end() - 1);
  for (std::size_t i = 0; i + 1 < constraint_start_.size(); ++i) {
    for (std::size_t k = constraint_start_[i]; k < constraint_start_[i + 1]; ++k) {
      column_constraints_[next[static_cast<std::size_t>(constraint_columns_[k])]++] =
          static_cast<int>(i);
    }
  }
}

void TangentPattern::read_constraints(const Model& model) {
  for (const DotConstraint& constraint : model.dot_constraints()) {
    const auto first = static_cast<std::ptrdiff_t>(constraint_columns_.size());
    for (const int index : {constraint.a, constraint.b, constraint.c, constraint.d}) {
      const Point& point = model.points()[static_cast<std::size_t>(index)];
      const auto begin = constraint_columns_.begin() + first;
      if (point.is_fixed() ||
          std::find(begin, constraint_columns_.end(), point.offset) != constraint_columns_.end()) {
        continue;
      }
      for (int axis = 0; axis < model.dimension(); ++axis) {
        constraint_columns_.push_back(point.offset + axis);
      }
    }
    constraint_start_.push_back(constraint_columns_.size());
  }
  for (const LinearConstraint& constraint : model.linear_constraints()) {
    for (const auto& term : constraint.terms) constraint_columns_.push_back(term.coordinate);
    constraint_start_.push_back(constraint_columns_.size());
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
    const auto i = static_cast<std::size_t>(column_constraints_[k]);
    for (std::size_t p = constraint_start_[i]; p < constraint_start_[i + 1]; ++p) {
      collect(col, constraint_columns_[p]);
    }
  }
  return rows_;
}

}  // namespace mbs
