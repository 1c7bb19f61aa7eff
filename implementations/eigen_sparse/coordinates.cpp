// Numbering of the unknowns and the pattern of the tangent matrix.
#include "coordinates.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace mbs::eigen_sparse {
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

/// The entries of a symmetric matrix while its pattern grows: at first those of M.
class GrowingPattern {
 public:
  GrowingPattern(const Model& model, const Coordinates& coordinates)
      : coordinates_(coordinates), entries_(mass_entries(model, coordinates)) {}

  /// A position for every two unknowns of an item.
  template <class Items>
  void add(const Items& items) {
    for (const auto& item : items) {
      append_columns(coordinates_, ends_of(item), coupled_);
      add_clique();
    }
  }
  void add(std::span<const LinearConstraint> constraints) {
    for (const LinearConstraint& constraint : constraints) {
      for (const auto& term : constraint.terms) {
        coupled_.push_back(coordinates_.of_unknown(term.coordinate));
      }
      add_clique();
    }
  }
  [[nodiscard]] SparseMatrix matrix() const {
    SparseMatrix matrix(coordinates_.variables(), coordinates_.variables());
    matrix.setFromTriplets(entries_.begin(), entries_.end());
    return matrix;
  }

 private:
  void add_clique() {
    for (const int row : coupled_) {
      for (const int col : coupled_) entries_.emplace_back(row, col, 0.0);
    }
    coupled_.clear();
  }

  const Coordinates& coordinates_;
  std::vector<Eigen::Triplet<double>> entries_;
  std::vector<int> coupled_;
};

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

SparseMatrix stiffness_pattern(const Model& model, const Coordinates& coordinates) {
  GrowingPattern pattern(model, coordinates);
  pattern.add(model.springs());
  pattern.add(model.torsion_springs());
  return pattern.matrix();
}

SparseMatrix tangent_pattern(const Model& model, const Coordinates& coordinates) {
  GrowingPattern pattern(model, coordinates);
  pattern.add(model.dot_constraints());
  pattern.add(model.bilinear_constraints());
  pattern.add(model.springs());
  pattern.add(model.torsion_springs());
  pattern.add(model.linear_constraints());
  return pattern.matrix();
}

Coordinates numbered_by(const Model& model, std::vector<int> (*order)(const SparseMatrix&, Tuning),
                        Tuning tuning) {
  std::vector<int> identity(model.variables());
  std::iota(identity.begin(), identity.end(), 0);
  return {model, order(tangent_pattern(model, {model, std::move(identity)}), tuning)};
}

}  // namespace mbs::eigen_sparse
