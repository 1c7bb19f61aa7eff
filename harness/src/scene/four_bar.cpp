// Generates the N-loop four-bar mechanism of paper/README.md.
#include <fmt/format.h>

#include "scene/mass_writer.hpp"
#include "scene/scene.hpp"
#include "usage_error.hpp"

namespace mbs {

ModelData four_bar(int loops) {
  if (loops < 1 || loops > kMostLoops) {
    throw UsageError(
        fmt::format("four-bar: found N = {}, allowed are 1 to {} loops", loops, kMostLoops));
  }
  const Vector3 gravity{0.0, -9.81, 0.0};  // m/s^2
  const int rods = loops + 1;
  ModelData data;
  data.points.reserve(static_cast<std::size_t>(2 * rods));
  for (int i = 0; i < rods; ++i) {
    data.points.push_back({fmt::format("A{}", i), -1, {static_cast<double>(i), 0.0, 0.0}});
  }
  for (int i = 0; i < rods; ++i) {
    data.points.push_back({fmt::format("B{}", i), 2 * i, {static_cast<double>(i), 1.0, 0.0}});
    data.initial_velocity.insert(data.initial_velocity.end(), {1.0, 0.0});
  }
  MassWriter mass(data);
  for (int i = 0; i < rods; ++i) {
    mass.add_rod({i, rods + i, 1.0, 1.0, fmt::format("A{}-B{}", i, i)}, gravity);
  }
  for (int i = 1; i < rods; ++i) {
    mass.add_rod({rods + i - 1, rods + i, 1.0, 1.0, fmt::format("B{}-B{}", i - 1, i)}, gravity);
  }
  mass.finish();
  return data;
}

Elements four_bar_elements(int loops) {
  const int rods = loops + 1;
  Elements elements;
  for (int i = 0; i < rods; ++i) {
    elements.rods.push_back({fmt::format("A{}-B{}", i, i), i, rods + i});
  }
  for (int i = 1; i < rods; ++i) {
    elements.rods.push_back({fmt::format("B{}-B{}", i - 1, i), rods + i - 1, rods + i});
  }
  Output position, velocity;
  position.name = "B0";
  velocity.name = "vB0";
  velocity.kind = Output::Kind::velocity;
  position.point = velocity.point = rods;
  elements.outputs = {position, velocity};
  return elements;
}

}  // namespace mbs
