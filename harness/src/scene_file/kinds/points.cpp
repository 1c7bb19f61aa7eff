// Points and unit vectors; Lowering numbers them.
#include "scene_file/kinds/drivers.hpp"
#include "scene_file/kinds/kinds.hpp"

namespace mbs {
namespace {

/// Axes that "driven" leaves out stay where "position" has them.
void read_driven(SceneReader& reader, const JsonNode& node, DraftPoint& point) {
  if (reader.is_spatial()) {
    node.allow_keys({"x", "y", "z"});
  } else {
    node.allow_keys({"x", "y"});
  }
  bool moves = false;
  for (std::size_t axis = 0; axis < static_cast<std::size_t>(reader.draft().dimension); ++axis) {
    const std::string key(1, static_cast<char>('x' + axis));
    const auto function = node.find(key);
    if (!function && !point.position) static_cast<void>(node.get(key));
    point.motion[axis] =
        function ? read_driver(reader, *function, "in m") : (*point.position)[axis];
    moves = moves || !point.motion[axis].is_constant();
  }
  point.hold = moves ? Hold::driven : Hold::fixed;
  if (moves) return;
  point.position.emplace();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    (*point.position)[axis] = point.motion[axis].at(0.0).value;
  }
}

}  // namespace

void read_point(SceneReader& reader, const JsonNode& node) {
  node.allow_keys({"name", "position", "velocity", "fixed", "driven"});
  const JsonNode name = node.get("name");
  DraftPoint& point = reader.draft().point(reader.add_name(name, name.text(), false));
  point.node = node;
  if (const auto position = node.find("position")) point.position = reader.coordinates(*position);
  const auto fixed = node.find("fixed");
  if (fixed && fixed->boolean()) point.hold = Hold::fixed;
  if (const auto driven = node.find("driven")) {
    if (point.hold == Hold::fixed) driven->fail("a driven point that is fixed", "one of the two");
    read_driven(reader, *driven, point);
  }
  if (point.hold == Hold::fixed && !point.position) static_cast<void>(node.get("position"));
  if (const auto velocity = node.find("velocity")) {
    point.velocity = reader.coordinates(*velocity);
    if (point.hold != Hold::free && *point.velocity != Vector3{}) {
      velocity->fail("a moving fixed or driven point", "zero, or a point that is free");
    }
  }
}

void read_vector(SceneReader& reader, const JsonNode& node) {
  if (!reader.is_spatial()) {
    node.fail("a unit vector in a planar scene", "none, or \"dimension\": 3");
  }
  node.allow_keys({"name", "direction", "velocity", "fixed"});
  const JsonNode name = node.get("name");
  DraftPoint& vector = reader.draft().point(reader.add_name(name, name.text(), true));
  vector.node = node;
  if (const auto direction = node.find("direction")) {
    vector.position = reader.unit_vector(*direction);
  }
  if (const auto velocity = node.find("velocity")) vector.velocity = reader.coordinates(*velocity);
  const auto fixed = node.find("fixed");
  if (!fixed || !fixed->boolean()) return;
  if (vector.velocity.value_or(Vector3{}) != Vector3{}) {
    node.get("velocity").fail("a moving fixed unit vector", "zero, or a unit vector that is free");
  }
  if (!vector.position) static_cast<void>(node.get("direction"));
  vector.hold = Hold::fixed;
}

}  // namespace mbs
