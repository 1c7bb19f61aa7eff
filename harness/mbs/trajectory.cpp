// CSV rows of named points.
#include "mbs/trajectory.hpp"

#include <fmt/format.h>

#include <iterator>

namespace mbs {

TrajectoryFile::TrajectoryFile(const std::string& path, const Model& model)
    : model_(model), file_(path) {
  const std::string axes = model.dimension() == 2 ? "xy" : "xyz";
  std::string header = "t";
  for (const Point& point : model.points()) {
    for (const char axis : axes) header += fmt::format(",{}.{}", point.name, axis);
    for (const char axis : axes) header += fmt::format(",{}.v{}", point.name, axis);
  }
  file_.stream() << header << '\n';
}

void TrajectoryFile::write(double t, const State& state) {
  fmt::memory_buffer row;
  auto out = std::back_inserter(row);
  fmt::format_to(out, "{}", t);
  for (const Point& point : model_.points()) {
    for (int axis = 0; axis < model_.dimension(); ++axis) {
      fmt::format_to(out, ",{}",
                     point.is_fixed() ? point.position[axis] : state.q[point.offset + axis]);
    }
    for (int axis = 0; axis < model_.dimension(); ++axis) {
      fmt::format_to(out, ",{}", point.is_fixed() ? 0.0 : state.v[point.offset + axis]);
    }
  }
  row.push_back('\n');
  file_.stream().write(row.data(), static_cast<std::streamsize>(row.size()));
}

}  // namespace mbs
