// Names and places of what a scene is made of.
#include "describe/elements.hpp"

#include "run/scene_motion.hpp"

namespace mbs {
namespace {

using nlohmann::json;

json pair(const SceneMotion& motion, int a, int b) {
  return json::array({motion.name(a), motion.name(b)});
}

json names(const SceneMotion& motion, const std::vector<int>& indices) {
  json result = json::array();
  for (const int index : indices) result.push_back(motion.name(index));
  return result;
}

json points(const Scene& scene, const SceneMotion& motion) {
  const Model& model = scene.model;
  std::vector<bool> driven(model.points().size(), false);
  for (const DrivenPoint& point : model.driven_points()) {
    driven[static_cast<std::size_t>(point.point)] = true;
  }
  std::vector<bool> helper(static_cast<std::size_t>(motion.points()), false);
  for (const int index : scene.elements.helpers) helper[static_cast<std::size_t>(index)] = true;
  json result = json::array();
  for (int i = 0; i < motion.points(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    const bool is_marker = k >= driven.size();
    const auto position = motion.position(i);
    const char* kind = is_marker                      ? "marker"
                       : model.points()[k].is_vector  ? "vector"
                       : driven[k]                    ? "driven"
                       : model.points()[k].is_fixed() ? "fixed"
                                                      : "free";
    result.push_back({{"name", motion.name(i)},
                      {"kind", kind},
                      {"helper", static_cast<bool>(helper[k])},
                      {"position", std::vector<double>(position.begin(),
                                                       position.begin() + model.dimension())}});
  }
  return result;
}

/// Rods, distances, springs, force laws.
template <class Elements>
json pairs(const SceneMotion& motion, const Elements& elements) {
  json result = json::array();
  for (const auto& element : elements) {
    result.push_back({{"name", element.name}, {"between", pair(motion, element.a, element.b)}});
  }
  return result;
}

/// Torsion springs, torque laws.
template <class Elements>
json corners(const SceneMotion& motion, const Elements& elements) {
  json result = json::array();
  for (const auto& element : elements) {
    result.push_back({{"name", element.name},
                      {"from", pair(motion, element.b, element.a)},
                      {"to", pair(motion, element.d, element.c)}});
  }
  return result;
}

}  // namespace

json elements_json(const Scene& scene) {
  const Model& model = scene.model;
  const std::vector<double> zero(static_cast<std::size_t>(model.variables()), 0.0);
  const State start{
      {model.initial_position().begin(), model.initial_position().end()}, zero, zero, {}, 0.0};
  SceneMotion motion(scene);
  motion.set(0.0, start);
  json bodies = json::array(), outputs = json::array();
  for (const auto& body : scene.elements.bodies) {
    bodies.push_back({{"name", body.name},
                      {"points", names(motion, body.points)},
                      {"vectors", names(motion, body.vectors)}});
  }
  for (const Output& output : scene.elements.outputs) outputs.push_back(output.name);
  return {{"points", points(scene, motion)},
          {"rods", pairs(motion, scene.elements.rods)},
          {"distances", pairs(motion, scene.elements.distances)},
          {"bodies", bodies},
          {"springs", pairs(motion, model.springs())},
          {"torsion_springs", corners(motion, model.torsion_springs())},
          {"force_laws", pairs(motion, model.force_laws())},
          {"torque_laws", corners(motion, model.torque_laws())},
          {"outputs", outputs}};
}

}  // namespace mbs
