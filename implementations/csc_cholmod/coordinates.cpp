// Numbers the coordinates of all points.
#include "coordinates.hpp"

#include <utility>

namespace mbs::csc_cholmod {

Coordinates::Coordinates(const Model& model, std::vector<int> number)
    : dimension_(model.dimension()), number_(std::move(number)) {
  place_.reserve(model.points().size() * dimension_);
  for (const Point& point : model.points()) {
    for (int axis = 0; axis < dimension_; ++axis) {
      if (point.is_fixed()) {
        place_.push_back(all());
        constants_.push_back(point.position[axis]);
      } else {
        place_.push_back(number_[point.offset + axis]);
      }
    }
  }
}

Places Coordinates::places(int point) const {
  Places result{zero(), zero(), zero()};
  for (int axis = 0; axis < dimension_; ++axis) result[axis] = place(point, axis);
  return result;
}

Places Coordinates::axis_places(int point) const {
  return point < 0 ? Places{zero(), zero(), zero() + 1} : places(point);
}

}  // namespace mbs::csc_cholmod
