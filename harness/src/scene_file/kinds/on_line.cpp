// A point on a line.
#include <fmt/format.h>

#include <algorithm>

#include "printable.hpp"
#include "scene_file/kinds/joint_parts.hpp"
#include "scene_file/kinds/kinds.hpp"

namespace mbs {
namespace {

/// A fixed direction has fixed vectors across it; a body's needs two of the body's.
void read_line_in_space(SceneReader& reader, const JsonNode& node, DraftConstraint& constraint) {
  const JsonNode direction = node.get("direction");
  constraint.direction = reader.vector(direction);
  reader.use_between(node, constraint.points);
  reader.use(constraint.direction);
  const DraftPoint& along = reader.draft().point(constraint.direction);
  if (along.hold == Hold::fixed) return;
  if (along.bodies.empty()) {
    direction.fail("the free unit vector " + in_quotes(along.name) + " of no body",
                   "a fixed unit vector or one of a body");
  }
  const int with_line = common_body(reader.draft(), {constraint.direction, constraint.points[1]});
  const int body = with_line >= 0 ? with_line : along.bodies.front();
  const Vector3 local = reader.local_of(body, constraint.direction);
  constraint.normals[0] = reader.vector_across(body, local);
  const Vector3 first = reader.local_of(body, constraint.normals[0]);
  constraint.normals[1] = reader.vector_across(body, local, &first);
}

}  // namespace

void write_line_rows(Lowering& scene, const DraftConstraint& constraint) {
  const DraftDirection off{constraint.points[1], constraint.points[0]};
  if (scene.draft().dimension == 2) {
    const DraftDirection line{constraint.points[1], constraint.points[2]};
    const Vector3 direction = scene.along(line);
    const double length = norm(direction);
    if (!(length > 0.0)) {
      constraint.node.get("line").fail("two points that start at the same place",
                                       "a line through two different places");
    }
    scene.refuse_same_dot(constraint.node, off, line);
    if (scene.draft().is_fixed(line)) {
      const Vector3 normal = (1.0 / length) * Vector3{-direction[1], direction[0], 0.0};
      scene.distinct_linear(constraint.node, constraint.name, scene.fixed_dot(normal, off), 0.0);
    } else {
      scene.rows().bilinear(constraint.name, scene.edge(off), scene.edge(line), kCrossProduct, 0.0);
    }
    return;
  }
  const DraftDirection line{-1, constraint.direction};
  scene.refuse_same_dot(constraint.node, off, line);
  if (constraint.normals[0] >= 0) {
    for (int k = 0; k < 2; ++k) {
      const DraftDirection normal{-1, constraint.normals[static_cast<std::size_t>(k)]};
      scene.rows().dot(fmt::format("{} {}", constraint.name, k + 1), scene.edge(normal),
                       scene.edge(off), 0.0);
    }
    return;
  }
  const Vector3 u = scene.along(line);
  const Vector3 normal = any_across(u);
  scene.distinct_linear(constraint.node, constraint.name + " 1", scene.fixed_dot(normal, off), 0.0);
  scene.distinct_linear(constraint.node, constraint.name + " 2",
                        scene.fixed_dot(cross(u, normal), off), 0.0);
}

void read_line(SceneReader& reader, const JsonNode& node, DraftConstraint& constraint) {
  const int at = reader.point(node.get("point"));
  const JsonNode line = node.get("line");
  if (reader.is_spatial()) {
    constraint.points = {at, reader.point(line)};
  } else {
    const auto [a, b] = reader.point_pair(line);
    constraint.points = {at, a, b};
  }
  if (std::count(constraint.points.begin(), constraint.points.end(), at) > 1) {
    line.fail("the point " + in_quotes(node.get("point").text()) + " itself",
              "a line through other points");
  }
  if (reader.is_spatial()) return read_line_in_space(reader, node, constraint);
  reader.use_between(node, constraint.points);
}

void read_on_line(SceneReader& reader, const JsonNode& node, DraftConstraint& constraint) {
  if (reader.is_spatial()) {
    node.allow_keys({"type", "name", "point", "line", "direction"});
  } else {
    node.allow_keys({"type", "name", "point", "line"});
  }
  read_line(reader, node, constraint);
}

Lowering::Force lower_on_line(Lowering& scene, const DraftConstraint& constraint) {
  write_line_rows(scene, constraint);
  return {Output::Force::vector, {}, {constraint.points[1], constraint.points[0]}};
}

}  // namespace mbs
