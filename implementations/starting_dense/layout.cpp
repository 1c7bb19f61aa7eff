// Lines the points up: free, driven, fixed, and the axis of the plane.
#include "layout.hpp"

#include <algorithm>

namespace mbs::starting_dense {

Layout::Layout(const Model& model)
    : dimension(model.dimension()),
      variables(model.variables()),
      moving(variables + dimension * static_cast<int>(model.driven_points().size())),
      at(model.points().size(), -1),
      position(model.initial_position().begin(), model.initial_position().end()) {
  const auto append = [&](int point) {
    const std::array<double, 3>& constant = model.points()[point].position;
    at[point] = static_cast<int>(position.size());
    position.insert(position.end(), constant.begin(), constant.begin() + dimension);
  };
  for (const DrivenPoint& driven : model.driven_points()) append(driven.point);
  for (int i = 0; i < static_cast<int>(at.size()); ++i) {
    if (!model.points()[i].is_fixed()) at[i] = model.points()[i].offset;
    if (at[i] < 0) append(i);
  }
  if (dimension == 2) {
    planar_axis = static_cast<int>(position.size());
    position.insert(position.end(), {0.0, 0.0, 1.0});
  }
}

std::vector<Share> Layout::shares(const std::array<int, 4>& points, int end) const {
  const auto [a, b, c, d] = points;
  std::vector<Share> result;
  for (auto point = points.begin(); point != points.end(); ++point) {
    if (at[*point] >= end || std::find(points.begin(), point, *point) != point) continue;
    result.push_back({at[*point], static_cast<double>((*point == a) - (*point == b)),
                      static_cast<double>((*point == c) - (*point == d))});
  }
  return result;
}

}  // namespace mbs::starting_dense
