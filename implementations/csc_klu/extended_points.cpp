// Where points are in the extended vector, and which free points a term of the equations moves.
#include "extended_points.hpp"

#include <algorithm>

namespace mbs::csc_klu {

std::vector<int> extended_offsets(const Model& model) {
  std::vector<int> offsets;
  int fixed = model.variables();
  for (const Point& point : model.points()) {
    offsets.push_back(point.is_fixed() ? fixed : point.offset);
    if (point.is_fixed()) fixed += model.dimension();
  }
  return offsets;
}

std::vector<double> fixed_coordinates(const Model& model) {
  std::vector<double> coordinates;
  for (const Point& point : model.points()) {
    if (!point.is_fixed()) continue;
    const auto begin = point.position.begin();
    coordinates.insert(coordinates.end(), begin, begin + model.dimension());
  }
  return coordinates;
}

void append_moved_points(const Model& model, std::initializer_list<int> abcd,
                         std::vector<MovedPoint>& points) {
  static constexpr MovedPoint kSigns[] = {
      {0, 1.0, 0.0}, {0, -1.0, 0.0}, {0, 0.0, 1.0}, {0, 0.0, -1.0}};
  const auto start = std::ssize(points);
  const MovedPoint* sign = kSigns;
  for (const int index : abcd) {
    const auto& [ignored, first, second] = *sign++;
    const Point& point = model.points()[index];
    if (point.is_fixed()) continue;
    const auto known = std::find_if(points.begin() + start, points.end(), [&](const MovedPoint& p) {
      return p.coordinate == point.offset;
    });
    if (known == points.end()) {
      points.push_back({point.offset, first, second});
    } else {
      known->first += first;
      known->second += second;
    }
  }
}

}  // namespace mbs::csc_klu
