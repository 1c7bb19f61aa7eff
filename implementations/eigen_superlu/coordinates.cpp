// Numbering of the unknowns and the pattern of the tangent matrix.
#include "coordinates.hpp"

#include <algorithm>
#include <utility>

namespace mbs::eigen_superlu {
namespace {

std::vector<Eigen::Triplet<double>> mass_entries(const Model& model,
                                                 const Coordinates& coordinates) {
  std::vector<Eigen::Triplet<double>> entries;
  for (const MassEntry& entry : model.mass()) {
    const int row = coordinates.of_unknown(entry.row), col = coordinates.of_unknown(entry.col);
    entries.emplace_back(row, col, entry.value);
    if (row != col) entries.emplace_back(col, row, entry.value);
  }
  return entries;
}

}  // namespace

Coordinates::Coordinates(const Model& model, std::vector<int> position)
    : dimension_(model.dimension()), position_(std::move(position)) {
  for (const Point& point : model.points()) {
    for (int axis = 0; axis < dimension_; ++axis) {
      if (point.is_fixed()) {
        points_.push_back(extended());
        fixed_.push_back(point.position[axis]);
      } else {
        points_.push_back(position_[point.offset + axis]);
      }
    }
  }
}

void Coordinates::gather(const std::vector<double>& source, Vector& target) const {
  for (int i = 0; i < variables(); ++i) target[position_[i]] = source[i];
}

void Coordinates::scatter(const Vector& source, std::vector<double>& target) const {
  for (int i = 0; i < variables(); ++i) target[i] = source[position_[i]];
}

std::vector<int> free_ones(const Coordinates& coordinates, std::span<const int> points) {
  std::vector<int> free;
  for (const int point : points) {
    const bool seen = std::find(free.begin(), free.end(), point) != free.end();
    if (!seen && coordinates.is_free(point)) free.push_back(point);
  }
  return free;
}

void append_columns(const Coordinates& coordinates, std::span<const int> points,
                    std::vector<int>& columns) {
  for (const int point : free_ones(coordinates, points)) {
    for (int axis = 0; axis < coordinates.dimension(); ++axis) {
      columns.push_back(coordinates.of_point(point, axis));
    }
  }
}

RowSparseMatrix mass_matrix(const Model& model, const Coordinates& coordinates) {
  const auto entries = mass_entries(model, coordinates);
  RowSparseMatrix mass(coordinates.variables(), coordinates.variables());
  mass.setFromTriplets(entries.begin(), entries.end());
  return mass;
}

SparseMatrix tangent_pattern(const Model& model, const Coordinates& coordinates) {
  auto entries = mass_entries(model, coordinates);
  std::vector<int> coupled;
  const auto add_clique = [&] {
    for (const int row : coupled) {
      for (const int col : coupled) entries.emplace_back(row, col, 0.0);
    }
    coupled.clear();
  };
  const auto add_items = [&](const auto& items) {
    for (const auto& item : items) {
      append_columns(coordinates, ends_of(item), coupled);
      add_clique();
    }
  };
  add_items(model.dot_constraints());
  add_items(model.bilinear_constraints());
  add_items(model.springs());
  add_items(model.torsion_springs());
  for (const LinearConstraint& constraint : model.linear_constraints()) {
    for (const auto& term : constraint.terms) {
      coupled.push_back(coordinates.of_unknown(term.coordinate));
    }
    add_clique();
  }
  SparseMatrix pattern(coordinates.variables(), coordinates.variables());
  pattern.setFromTriplets(entries.begin(), entries.end());
  return pattern;
}

}  // namespace mbs::eigen_superlu
