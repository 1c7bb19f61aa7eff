// Rigid bodies.
#include <fmt/format.h>

#include <cmath>

#include "printable.hpp"
#include "scene/scene_reader.hpp"

namespace mbs {

void SceneReader::read_body(const JsonNode& node) {
  node.allow_keys({"name", "mass", "centre", "inertia", "points", "vectors", "pose", "velocity",
                   "angular_velocity"});
  const JsonNode name = node.get("name");
  if (!is_usable_name(name.text())) name.fail(kUsableName);
  static_cast<void>(element_name(node));
  const int index = static_cast<int>(draft_.bodies.size());
  body_of_.emplace(name.text(), index);
  draft_.bodies.push_back({node, name.text(), read_inertia(node), {}});
  if (const auto points = node.find("points")) read_items(*points, index, false);
  if (const auto vectors = node.find("vectors")) {
    if (!is_spatial()) vectors->fail("unit vectors in a planar scene", "none, or \"dimension\": 3");
    read_items(*vectors, index, true);
  }
  DraftBody& body = draft_.body(index);
  if (const auto pose = node.find("pose")) read_pose(*pose, body);
  if (const auto velocity = node.find("velocity")) body.velocity = coordinates(*velocity);
  if (const auto spin = node.find("angular_velocity")) {
    body.spin = is_spatial() ? coordinates(*spin) : Vector3{0.0, 0.0, spin->number()};
  }
}

Inertia SceneReader::read_inertia(const JsonNode& node) const {
  Inertia inertia;
  inertia.mass = node.get("mass").number_above(0.0, "a mass in kg above 0");
  if (const auto centre = node.find("centre")) inertia.centre = coordinates(*centre);
  const JsonNode tensor = node.get("inertia");
  if (!is_spatial()) {
    inertia.tensor[2][2] = tensor.number_above(0.0, "an inertia in kg m^2 above 0");
    return inertia;
  }
  const std::size_t count = tensor.items().size();
  if (count != 3 && count != 6) tensor.fail("[xx, yy, zz] or [xx, yy, zz, xy, xz, yz]");
  const std::vector<double> J = tensor.numbers(static_cast<int>(count));
  for (std::size_t i = 0; i < 3; ++i) inertia.tensor[i][i] = J[i];
  if (count == 6) {
    inertia.tensor[0][1] = inertia.tensor[1][0] = J[3];
    inertia.tensor[0][2] = inertia.tensor[2][0] = J[4];
    inertia.tensor[1][2] = inertia.tensor[2][1] = J[5];
  }
  if (!is_inertia(inertia, draft_.dimension)) {
    tensor.fail("a tensor that no body of some extent along every axis has",
                "positive principal moments, each smaller than the sum of the other two (a rod or "
                "plate has some thickness; for a thin rod there is \"rods\")");
  }
  return inertia;
}

void SceneReader::read_items(const JsonNode& node, int body, bool are_vectors) {
  for (const auto& [name, value] : node.members()) {
    const auto found = draft_.index_of.find(name);
    const bool is_new = found == draft_.index_of.end();
    const int index = is_new ? add_name(value, name, are_vectors) : found->second;
    DraftPoint& point = draft_.point(index);
    if (point.is_vector != are_vectors) {
      value.fail(
          fmt::format("the {} {}", point.is_vector ? "unit vector" : "point", in_quotes(name)),
          are_vectors ? "a unit vector" : "a point");
    }
    if (!point.bodies.empty() && point.bodies.back() == body) {
      value.fail("the name " + in_quotes(name) + " twice in one body", "once");
    }
    const Vector3 local = are_vectors ? unit_vector(value) : coordinates(value);
    if (point.bodies.empty()) point.item = draft_.body(body).items.size();
    draft_.body(body).items.push_back({index, local});
    point.bodies.push_back(body);
  }
}

void SceneReader::read_pose(const JsonNode& node, DraftBody& body) const {
  if (is_spatial()) {
    node.allow_keys({"position", "rotation"});
  } else {
    node.allow_keys({"position", "angle"});
  }
  if (const auto position = node.find("position")) body.position = coordinates(*position);
  body.rotation = Vector3{};
  if (const auto rotation = node.find("rotation")) body.rotation = coordinates(*rotation);
  if (const auto angle = node.find("angle")) body.rotation = Vector3{0.0, 0.0, angle->number()};
}

}  // namespace mbs
