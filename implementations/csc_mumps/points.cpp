// Numbers the points of a model: free ones as the model has them, fixed ones behind.
#include "points.hpp"

#include <algorithm>

namespace mbs::csc_mumps {

ExtendedPoints::ExtendedPoints(const Model& model)
    : variables(model.variables()), dimension(model.dimension()) {
  offset.reserve(model.points().size());
  for (const Point& point : model.points()) {
    offset.push_back(point.is_fixed() ? variables + static_cast<int>(fixed.size()) : point.offset);
    if (!point.is_fixed()) continue;
    fixed.insert(fixed.end(), point.position.begin(), point.position.begin() + dimension);
  }
}

std::vector<int> ExtendedPoints::columns(std::initializer_list<int> points) const {
  std::vector<int> result;
  for (int point : points) {
    for (int axis = 0; axis < dimension && is_free(offset[point]); ++axis) {
      result.push_back(offset[point] + axis);
    }
  }
  std::sort(result.begin(), result.end());
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

}  // namespace mbs::csc_mumps
