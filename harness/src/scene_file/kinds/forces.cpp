// Forces and torques.
#include <algorithm>

#include "printable.hpp"
#include "scene_file/kinds/drivers.hpp"
#include "scene_file/kinds/kinds.hpp"

namespace mbs {
namespace {

/// In the plane the body's two coordinate points take the couple; in space a vector of the body's
/// across the axis does, which must stay across it.
void read_torque_on_body(SceneReader& reader, const JsonNode& node, DraftTorque& torque) {
  torque.body = reader.body(node);
  if (!reader.is_spatial()) return;
  const DraftBody& owner = reader.draft().body(torque.body);
  for (const DraftBody::Item& item : owner.items) {
    if (item.point != torque.axis) continue;
    const Vector3 along = item.local;
    torque.direction = {-1, reader.vector_across(torque.body, along)};
    return;
  }
  torque.node.get("axis").fail(
      "the unit vector " + in_quotes(reader.draft().point(torque.axis).name) +
          ", which is not one of " + in_quotes(owner.name),
      "a unit vector among the body's \"vectors\" (or a direction in place of the body)");
}

}  // namespace

void read_force(SceneReader& reader, const JsonNode& node) {
  node.allow_keys({"name", "point", "force"});
  static_cast<void>(reader.element_name(node));
  const JsonNode at = node.get("point");
  const int index = reader.point(at);
  if (reader.draft().point(index).hold != Hold::free) {
    at.fail("the fixed or driven point " + in_quotes(at.text()),
            "a free point (a force there has no effect)");
  }
  reader.draft().point(index).is_loaded = true;
  DraftForce force{node, index};
  const JsonNode given = node.get("force");
  const auto axes = given.items();
  const auto dimension = static_cast<std::size_t>(reader.draft().dimension);
  const bool is_driven = std::ranges::any_of(axes, &JsonNode::is_object);
  if (!is_driven || axes.size() != dimension) {
    force.force = reader.coordinates(given);  // or its complaint
  } else {
    for (std::size_t axis = 0; axis < dimension; ++axis) {
      const TimeFunction part = read_driver(reader, axes[axis], "in N");
      if (part.is_constant()) {
        force.force[axis] = part.at(0.0).value;
      } else {
        force.driven[axis] = part;
      }
    }
  }
  reader.draft().forces.push_back(std::move(force));
}

/// At a point, or at those of its body that have coordinates.
void lower_forces(Lowering& scene) {
  for (const DraftForce& force : scene.draft().forces) {
    const auto push = [&](int point, const Matrix3& weight) {
      scene.mass().push(point, multiply_transposed(weight, force.force));
      if (force.pusher >= 0) scene.mass().add(point, force.pusher, transposed(weight));
    };
    const DraftPoint& at = scene.draft().point(force.point);
    if (at.index >= 0) {
      push(at.index, kIdentity);
    } else {
      const auto marker = static_cast<std::size_t>(at.marker);
      for (const Marker::Part& part : scene.elements().markers[marker].parts) {
        push(part.point, part.matrix);
      }
    }
  }
}

void read_torque(SceneReader& reader, const JsonNode& node) {
  node.allow_keys({"name", "direction", "body", "axis", "torque"});
  DraftTorque torque{node, reader.element_name(node)};
  torque.torque = read_driver(reader, node.get("torque"), "in N m");
  torque.axis = reader.axis(node);
  if (node.find("body")) {
    if (const auto other = node.find("direction")) {
      other->fail("a direction beside a body", "one of the two");
    }
    read_torque_on_body(reader, node.get("body"), torque);
  } else {
    const JsonNode turned = node.get("direction");
    torque.direction = reader.direction(turned);
    reader.use(torque.direction);
    if (!reader.draft().is_free(torque.direction)) {
      turned.fail("a fixed or driven direction", "one that a torque can turn");
    }
  }
  reader.draft().torques.push_back(std::move(torque));
}

namespace {

/// A law from a fixed direction across the axis, at any angle: -1 N m times the factor turns back.
void lower_driven_torque(Lowering& scene, const DraftTorque& torque, const Lowering::Edge& turned,
                         int axis) {
  Vector3 across{1.0, 0.0, 0.0};
  if (axis >= 0) {
    if (scene.draft().point(torque.axis).hold != Hold::fixed) {
      torque.node.get("torque").fail(
          "a function of time about an axis that moves",
          "a number, a fixed axis, or a torque law between two directions, with a factor");
    }
    across = any_across(scene.position(torque.axis));
  }
  const int from = scene.add_hidden(torque.node.path() + ".from", true);
  scene.model().points[static_cast<std::size_t>(from)].position = across;
  const Curve back{{}, {{0.0, {-1.0, 0.0, 0.0, 0.0}}}};
  scene.model().torque_laws.push_back(
      {from, scene.zero(), turned.a, turned.b, axis, {{}, back, torque.torque}, torque.name});
}

}  // namespace

void lower_torques(Lowering& scene) {
  for (const DraftTorque& torque : scene.draft().torques) {
    Lowering::Edge turned;
    if (torque.body >= 0 && torque.direction.to < 0) {
      const DraftBody& body = scene.draft().body(torque.body);
      turned = {scene.index(body.items[body.basis[1]].point),
                scene.index(body.items[body.basis[0]].point)};
    } else {
      turned = scene.edge(torque.direction);
    }
    const int axis = torque.axis < 0 ? -1 : scene.index(torque.axis);
    if (torque.torque.is_constant()) {
      scene.model().couples.push_back(
          {turned.a, turned.b, axis, torque.torque.at(0.0).value, torque.name});
    } else {
      lower_driven_torque(scene, torque, turned, axis);
    }
  }
}

}  // namespace mbs
