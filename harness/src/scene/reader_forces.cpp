// Springs, dampers, forces and torques.
#include <cmath>

#include "printable.hpp"
#include "scene/scene_reader.hpp"

namespace mbs {
namespace {

double optional_not_negative(const JsonNode& node, std::string_view key, const char* allowed) {
  const auto found = node.find(key);
  return found ? found->number_at_least(0.0, allowed) : 0.0;
}

}  // namespace

void SceneReader::read_spring(const JsonNode& node) {
  node.allow_keys({"name", "between", "stiffness", "damping", "length"});
  const JsonNode between = node.get("between");
  const auto [a, b] = point_pair(between);
  use_between(between, {a, b});
  DraftSpring spring{node, element_name(node), a, b};
  spring.stiffness = optional_not_negative(node, "stiffness", "a stiffness in N/m of at least 0");
  spring.damping = optional_not_negative(node, "damping", "a damping in N s/m of at least 0");
  if (const auto length = node.find("length")) {
    spring.length = length->number_at_least(0.0, "a length in m of at least 0");
  }
  draft_.springs.push_back(std::move(spring));
}

void SceneReader::read_torsion_spring(const JsonNode& node) {
  node.allow_keys({"name", "from", "to", "axis", "stiffness", "damping", "angle"});
  DraftTorsionSpring spring{node, element_name(node), direction(node.get("from")),
                            direction(node.get("to"))};
  use_directions(node, spring.from, spring.to);
  spring.axis = axis(node);
  spring.stiffness =
      optional_not_negative(node, "stiffness", "a stiffness in N m/rad of at least 0");
  spring.damping = optional_not_negative(node, "damping", "a damping in N m s/rad of at least 0");
  if (const auto angle = node.find("angle")) spring.angle = angle->number();
  draft_.torsion_springs.push_back(std::move(spring));
}

void SceneReader::use_directions(const JsonNode& node, const DraftDirection& from,
                                 const DraftDirection& to) {
  std::vector<int> points{from.to, to.to};
  for (const DraftDirection& d : {from, to}) {
    if (d.from >= 0) points.push_back(d.from);
  }
  use_between(node, points);
}

void SceneReader::read_force(const JsonNode& node) {
  node.allow_keys({"name", "point", "force"});
  static_cast<void>(element_name(node));
  const JsonNode at = node.get("point");
  const int index = point(at);
  if (draft_.point(index).hold != Hold::free) {
    at.fail("the fixed or driven point " + in_quotes(at.text()),
            "a free point (a force there has no effect)");
  }
  draft_.point(index).is_loaded = true;
  draft_.forces.push_back({node, index, coordinates(node.get("force"))});
}

void SceneReader::read_torque(const JsonNode& node) {
  node.allow_keys({"name", "direction", "body", "axis", "torque"});
  DraftTorque torque{node, element_name(node)};
  torque.torque = node.get("torque").number();
  torque.axis = axis(node);
  if (node.find("body")) {
    if (const auto other = node.find("direction")) {
      other->fail("a direction beside a body", "one of the two");
    }
    read_torque_on_body(node.get("body"), torque);
  } else {
    const JsonNode turned = node.get("direction");
    torque.direction = direction(turned);
    use(torque.direction);
    if (!draft_.is_free(torque.direction)) {
      turned.fail("a fixed or driven direction", "one that a torque can turn");
    }
  }
  draft_.torques.push_back(std::move(torque));
}

/// In the plane the body's two coordinate points take the couple; in space a vector of the body's
/// across the axis does, which must stay across it.
void SceneReader::read_torque_on_body(const JsonNode& node, DraftTorque& torque) {
  torque.body = body(node);
  if (!is_spatial()) return;
  const DraftBody& owner = draft_.body(torque.body);
  for (const DraftBody::Item& item : owner.items) {
    if (item.point != torque.axis) continue;
    const Vector3 along = item.local;
    torque.direction = {-1, vector_across(torque.body, along)};
    return;
  }
  torque.node.get("axis").fail(
      "the unit vector " + in_quotes(draft_.point(torque.axis).name) + ", which is not one of " +
          in_quotes(owner.name),
      "a unit vector among the body's \"vectors\" (or a direction in place of the body)");
}

int SceneReader::axis(const JsonNode& node) {
  const auto found = node.find("axis");
  if (!is_spatial()) {
    if (found) found->fail("an axis in a planar scene", "none: it is z");
    return -1;
  }
  const int axis = vector(node.get("axis"));
  use(axis);
  return axis;
}

}  // namespace mbs
