// Set-up of Forces: elements, rows of gradients and where evaluation writes them.
#include <algorithm>

#include "forces.hpp"

namespace mbs::csc_mumps {

Forces::Forces(const Model& model, const ExtendedPoints& points, double step)
    : dimension_(model.dimension()), quarter_(step * step / 4.0) {
  const auto at = [&](int point) { return points.offset[point]; };
  const auto axis_at = [&](int axis) { return axis < 0 ? -1 : points.offset[axis]; };
  const auto weight = [&](const auto& element) {
    return 0.5 * step * element.damping + quarter_ * element.stiffness;  // Eq. (5)
  };
  start_.push_back(0);
  for (const Spring& spring : model.springs()) {
    springs_.push_back({at(spring.a), at(spring.b), spring.stiffness, spring.damping, spring.length,
                        weight(spring)});
    rank_.push_back(0.0);
    add_row(points, {spring.a, spring.b});
  }
  transverse_.resize(springs_.size());
  for (const TorsionSpring& spring : model.torsion_springs()) {
    torsion_springs_.push_back({at(spring.a), at(spring.b), at(spring.c), at(spring.d),
                                axis_at(spring.axis), spring.stiffness, spring.damping,
                                spring.angle});
    rank_.push_back(weight(spring));
    add_row(points, {spring.a, spring.b, spring.c, spring.d});
  }
  for (const Couple& couple : model.couples()) {
    couples_.push_back({at(couple.a), at(couple.b), axis_at(couple.axis), couple.torque});
    add_row(points, {couple.a, couple.b});
  }
  // What belongs to fixed points goes behind the last gradient, known only now.
  const int nowhere = static_cast<int>(column_.size());
  std::replace(write_order_.begin(), write_order_.end(), -1, nowhere);
  if (!empty()) gradient_.assign(column_.size() + 1, 0.0);
}

/// Appends an element's columns and the places of its points' gradients: axis outer, point inner.
void Forces::add_row(const ExtendedPoints& points, std::initializer_list<int> row) {
  const std::vector<int> columns = points.columns(row);
  for (int axis = 0; axis < dimension_; ++axis) {
    for (int point : row) {
      const int column = points.offset[point] + axis;
      const auto found = std::lower_bound(columns.begin(), columns.end(), column);
      const int place = start_.back() + static_cast<int>(found - columns.begin());
      write_order_.push_back(points.is_free(column) ? place : -1);
    }
  }
  column_.insert(column_.end(), columns.begin(), columns.end());
  start_.push_back(static_cast<int>(column_.size()));
}

}  // namespace mbs::csc_mumps
