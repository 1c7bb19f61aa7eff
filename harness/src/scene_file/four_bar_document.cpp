// Writes the N-loop four-bar mechanism as a user would.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "scene_file/load_scene.hpp"

namespace mbs {

nlohmann::json four_bar_document(int loops) {
  using nlohmann::json;
  json points = json::array(), rods = json::array();
  for (int i = 0; i <= loops; ++i) {
    points.push_back({{"name", fmt::format("A{}", i)}, {"position", {i, 0}}, {"fixed", true}});
  }
  for (int i = 0; i <= loops; ++i) {
    points.push_back({{"name", fmt::format("B{}", i)}, {"position", {i, 1}}, {"velocity", {1, 0}}});
  }
  const auto add_rod = [&rods](const std::string& a, const std::string& b) {
    rods.push_back({{"name", a + "-" + b}, {"between", {a, b}}, {"mass", 1}, {"length", 1}});
  };
  for (int i = 0; i <= loops; ++i) add_rod(fmt::format("A{}", i), fmt::format("B{}", i));
  for (int i = 1; i <= loops; ++i) add_rod(fmt::format("B{}", i - 1), fmt::format("B{}", i));
  return {
      {"gravity", {0.0, -9.81}},
      {"points", points},
      {"rods", rods},
      {"outputs", {{{"name", "B0"}, {"position", "B0"}}, {{"name", "vB0"}, {"velocity", "B0"}}}}};
}

}  // namespace mbs
