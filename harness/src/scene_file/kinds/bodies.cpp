// Rigid bodies: mass of their basis, fewest constraints, markers.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "printable.hpp"
#include "scene_file/body/shared_shape.hpp"
#include "scene_file/kinds/kinds.hpp"

namespace mbs {
namespace {

constexpr double kKnownTolerance = 1e-6;  // of the body's size

Inertia read_inertia(SceneReader& reader, const JsonNode& node) {
  Inertia inertia;
  inertia.mass = node.get("mass").number_above(0.0, "a mass in kg above 0");
  if (const auto centre = node.find("centre")) inertia.centre = reader.coordinates(*centre);
  const JsonNode tensor = node.get("inertia");
  if (!reader.is_spatial()) {
    inertia.tensor[2][2] = tensor.number_above(0.0, "an inertia in kg m^2 above 0");
    return inertia;
  }
  const std::vector<double> J = tensor.numbers();
  if (J.size() != 3 && J.size() != 6) tensor.fail("[xx, yy, zz] or [xx, yy, zz, xy, xz, yz]");
  for (std::size_t i = 0; i < 3; ++i) inertia.tensor[i][i] = J[i];
  if (J.size() == 6) {
    inertia.tensor[0][1] = inertia.tensor[1][0] = J[3];
    inertia.tensor[0][2] = inertia.tensor[2][0] = J[4];
    inertia.tensor[1][2] = inertia.tensor[2][1] = J[5];
  }
  if (!is_inertia(inertia, reader.draft().dimension)) {
    tensor.fail("a tensor that no body of some extent along every axis has",
                "positive principal moments, each smaller than the sum of the other two (a rod or "
                "plate has some thickness; for a thin rod there is \"rods\")");
  }
  return inertia;
}

void read_items(SceneReader& reader, const JsonNode& node, int body, bool are_vectors) {
  for (const auto& [name, value] : node.members()) {
    const auto found = reader.draft().index_of.find(name);
    const bool is_new = found == reader.draft().index_of.end();
    const int index = is_new ? reader.add_name(value, name, are_vectors) : found->second;
    DraftPoint& point = reader.draft().point(index);
    if (point.is_vector != are_vectors) {
      value.fail(
          fmt::format("the {} {}", point.is_vector ? "unit vector" : "point", in_quotes(name)),
          are_vectors ? "a unit vector" : "a point");
    }
    if (!point.bodies.empty() && point.bodies.back() == body) {
      value.fail("the name " + in_quotes(name) + " twice in one body", "once");
    }
    const Vector3 local = are_vectors ? reader.unit_vector(value) : reader.coordinates(value);
    if (point.bodies.empty()) point.item = reader.draft().body(body).items.size();
    reader.draft().body(body).items.push_back({index, local});
    point.bodies.push_back(body);
  }
}

void read_pose(SceneReader& reader, const JsonNode& node, DraftBody& body) {
  if (reader.is_spatial()) {
    node.allow_keys({"position", "rotation"});
  } else {
    node.allow_keys({"position", "angle"});
  }
  body.has_pose = true;
  if (const auto position = node.find("position")) body.position = reader.coordinates(*position);
  if (const auto rotation = node.find("rotation")) body.rotation = reader.coordinates(*rotation);
  if (const auto angle = node.find("angle")) body.rotation = Vector3{0.0, 0.0, angle->number()};
}

/// Lowers one body. `is_done` says which bodies have their constraints already: what holds points
/// of one of these together is not said again.
class BodyLowering {
 public:
  BodyLowering(Lowering& scene, int index, const std::vector<bool>& is_done)
      : scene_(scene),
        draft_(scene.draft()),
        index_(index),
        body_(scene.draft().body(index)),
        is_done_(is_done),
        algebra_(body_.inertia, scene.draft().dimension, body_.size, places(body_.basis),
                 places(body_.further)) {}

  void run() {
    lower_mass();
    check_known();
    lower_basis();
    for (const std::size_t item : body_.further) lower_further(item);
    for (std::size_t i = 0; i < body_.items.size(); ++i) {
      if (point(i).index < 0) lower_marker(i);
    }
  }

 private:
  using Edge = RowWriter::Edge;
  using Part = RowWriter::Part;

  [[nodiscard]] DraftPoint& point(std::size_t item) const {
    return draft_.point(body_.items[item].point);
  }
  [[nodiscard]] BodyPlace place(std::size_t item) const {
    return {body_.items[item].local, point(item).is_vector};
  }
  [[nodiscard]] std::vector<BodyPlace> places(const std::vector<std::size_t>& items) const {
    std::vector<BodyPlace> result;
    for (const std::size_t item : items) result.push_back(place(item));
    return result;
  }
  [[nodiscard]] bool is_fixed(std::size_t item) const { return point(item).hold == Hold::fixed; }

  void lower_mass() const {
    const auto& basis = body_.basis;
    for (std::size_t i = 0; i < basis.size(); ++i) {
      const int at = point(basis[i]).index;
      for (std::size_t j = 0; j <= i; ++j) {
        const Matrix3 block = block_of(algebra_.mass(i, j), draft_.dimension);
        scene_.mass().add(at, point(basis[j]).index, block);
      }
      scene_.mass().push(
          at, multiply(block_of(algebra_.weighing(i), draft_.dimension), draft_.gravity));
    }
    for (std::size_t k = 0; k < body_.further.size(); ++k) {
      const int at = point(body_.further[k]).index;
      scene_.mass().add(at, at, block_of(algebra_.share(k), draft_.dimension));
      scene_.mass().push(at, algebra_.weighing_further(k) * draft_.gravity);
    }
  }

  /// Fixed items beyond the basis, and fixed members of it, must be where the body has them.
  void check_known() const {
    for (std::size_t i = 0; i < body_.items.size(); ++i) {
      const auto& basis = body_.basis;
      if (!is_fixed(i) || std::find(basis.begin(), basis.end(), i) != basis.end()) continue;
      Vector3 off = *point(i).position;
      const BodyMass::Weights weights = algebra_.weights(place(i));
      for (std::size_t k = 0; k < basis.size(); ++k) {
        off = off - multiply(block_of(weights[k], draft_.dimension), *point(basis[k]).position);
      }
      const double length = std::hypot(off[0], off[1], off[2]);
      if (length <= kKnownTolerance * (point(i).is_vector ? 1.0 : body_.size)) continue;
      fail_known(in_quotes(point(i).name) + " off by " + fmt::format("{:.3g}", length));
    }
  }
  [[noreturn]] void fail_known(const std::string& what) const {
    body_.node.fail("fixed points or vectors that do not fit the body: " + what,
                    "places that turning and moving the body gives");
  }

  /// Of the basis: from its first point to a point, or a vector.
  [[nodiscard]] Edge edge(std::size_t k) const {
    return {point(body_.basis[k]).index,
            point(body_.basis[k]).is_vector ? scene_.zero() : point(body_.basis[0]).index};
  }
  [[nodiscard]] DraftDirection direction(std::size_t k) const {
    const int from = point(body_.basis[k]).is_vector ? -1 : body_.items[body_.basis[0]].point;
    return {from, body_.items[body_.basis[k]].point};
  }
  [[nodiscard]] Vector3 local_edge(std::size_t k) const {
    const Vector3& local = body_.items[body_.basis[k]].local;
    return point(body_.basis[k]).is_vector ? local : local - body_.items[body_.basis[0]].local;
  }

  /// The scalar products of the basis' directions from its first point: one in the plane, six in
  /// space, fewer where some are fixed. Those of two points are written as their distance.
  void lower_basis() {
    for (std::size_t k = 1; k < body_.basis.size(); ++k) {
      for (std::size_t l = k; l < body_.basis.size(); ++l) {
        const bool is_fixed_k = draft_.is_fixed(direction(k));
        const bool is_fixed_l = draft_.is_fixed(direction(l));
        const double value = dot(local_edge(k), local_edge(l));
        if (is_fixed_k && is_fixed_l) {
          check_product(k, l, value);
        } else if (is_fixed_k || is_fixed_l) {
          const std::size_t fixed = is_fixed_k ? k : l, moving = is_fixed_k ? l : k;
          if (is_said(of_edges(fixed, moving))) continue;
          scene_.rows().linear(label(fixed, moving),
                               scene_.fixed_dot(scene_.along(direction(fixed)), direction(moving)),
                               value);
        } else {
          lower_product(k, l, value);
        }
      }
    }
    std::vector<int> points;  // products cannot tell a body from its mirror image
    for (const std::size_t item : body_.basis) points.push_back(body_.items[item].point);
    static_cast<void>(is_said(points));
  }

  void check_product(std::size_t k, std::size_t l, double value) const {
    const Vector3 first = scene_.along(direction(k)), second = scene_.along(direction(l));
    const double scale = std::sqrt(dot(first, first) * dot(second, second));
    if (std::abs(dot(first, second) - value) <= kKnownTolerance * scale) return;
    fail_known(label(k, l));
  }

  void lower_product(std::size_t k, std::size_t l, double value) {
    const bool are_points = !point(body_.basis[k]).is_vector && !point(body_.basis[l]).is_vector;
    if (k == l || !are_points) {
      if (!is_said(of_edges(k, l))) {
        scene_.rows().dot(label(k, l), edge(k), edge(l), value);
      }
      return;
    }
    const int a = body_.items[body_.basis[k]].point, b = body_.items[body_.basis[l]].point;
    if (is_said({a, b})) return;
    const Vector3 between = local_edge(k) - local_edge(l);
    const Edge apart{draft_.point(a).index, draft_.point(b).index};
    scene_.rows().dot(label(k, l), apart, apart, dot(between, between));
  }

  [[nodiscard]] std::vector<int> of_edges(std::size_t k, std::size_t l) const {
    std::vector<int> points{body_.items[body_.basis[k]].point, body_.items[body_.basis[l]].point};
    if (direction(k).from >= 0 || direction(l).from >= 0) {
      points.push_back(body_.items[body_.basis[0]].point);
    }
    return points;
  }

  /// A further point or vector is a combination of the basis: a row an axis, of the weight that a
  /// distance of the body's size has.
  void lower_further(std::size_t item) {
    const BodyMass::Weights weights = algebra_.weights(place(item));
    std::vector<int> involved{body_.items[item].point};
    for (std::size_t k = 0; k < weights.size(); ++k) {
      if (weights[k] != 0.0) involved.push_back(body_.items[body_.basis[k]].point);
    }
    if (is_said(involved)) return;
    const double scale = 2.0 * (point(item).is_vector ? 1.0 : body_.size);
    for (int axis = 0; axis < draft_.dimension; ++axis) {
      const auto row = static_cast<std::size_t>(axis);
      std::vector<Part> parts{{point(item).index, axis, scale}};
      for (std::size_t k = 0; k < weights.size(); ++k) {
        const Matrix3 block = block_of(weights[k], draft_.dimension);
        for (int col = 0; col < draft_.dimension; ++col) {
          parts.push_back({point(body_.basis[k]).index, col,
                           -scale * block[row][static_cast<std::size_t>(col)]});
        }
      }
      scene_.rows().linear(
          fmt::format("{} {}.{}", title(), printable(point(item).name), "xyz"[axis]), parts, 0.0);
    }
  }

  void lower_marker(std::size_t item) {
    std::vector<Marker>& markers = scene_.elements().markers;
    point(item).marker = static_cast<int>(markers.size());
    Marker marker{point(item).name, {}, point(item).is_vector};
    const BodyMass::Weights weights = algebra_.weights(place(item));
    for (std::size_t k = 0; k < weights.size(); ++k) {
      if (weights[k] == 0.0) continue;
      marker.parts.push_back({point(body_.basis[k]).index, block_of(weights[k], draft_.dimension)});
    }
    markers.push_back(std::move(marker));
    GivenMarker given{point(item).marker, point(item).node->path(), point(item).is_vector, {}, {}};
    if (!point(item).is_placed) given.position = point(item).position;
    if (!point(item).is_carried) given.velocity = point(item).velocity;
    if (!given.position && !given.velocity) return;
    scene_.lowered().data.given_markers.push_back(std::move(given));
  }

  /// Whether a body that has its constraints holds these points and vectors together, which must
  /// then be in the shape that they have here.
  [[nodiscard]] bool is_said(const std::vector<int>& points) const {
    const int holder = common_body(draft_, points, [&](int other) {
      return other != index_ && is_done_[static_cast<std::size_t>(other)];
    });
    if (holder >= 0) check_same_shape(draft_, index_, holder, points);
    return holder >= 0;
  }

  [[nodiscard]] std::string title() const {
    return body_.node.path() + ' ' + in_quotes(body_.name);
  }
  [[nodiscard]] std::string name_of(std::size_t k) const {
    const std::string name = printable(point(body_.basis[k]).name);
    return point(body_.basis[k]).is_vector ? name
                                           : printable(point(body_.basis[0]).name) + '-' + name;
  }
  [[nodiscard]] std::string label(std::size_t k, std::size_t l) const {
    if (k == l) return title() + ' ' + name_of(k);
    return title() + ' ' + name_of(k) + " . " + name_of(l);
  }

  Lowering& scene_;
  SceneDraft& draft_;
  int index_;
  DraftBody& body_;
  const std::vector<bool>& is_done_;
  BodyMass algebra_;
};

}  // namespace

void read_body(SceneReader& reader, const JsonNode& node) {
  node.allow_keys({"name", "mass", "centre", "inertia", "points", "vectors", "pose", "velocity",
                   "angular_velocity"});
  const JsonNode name = node.get("name");
  if (!is_usable_name(name.text())) name.fail(kUsableName);
  static_cast<void>(reader.element_name(node));
  const int index = static_cast<int>(reader.draft().bodies.size());
  reader.draft().body_of.emplace(name.text(), index);
  reader.draft().bodies.push_back({node, name.text(), read_inertia(reader, node), {}});
  if (const auto points = node.find("points")) read_items(reader, *points, index, false);
  if (const auto vectors = node.find("vectors")) {
    if (!reader.is_spatial()) {
      vectors->fail("unit vectors in a planar scene", "none, or \"dimension\": 3");
    }
    read_items(reader, *vectors, index, true);
  }
  DraftBody& body = reader.draft().body(index);
  if (const auto pose = node.find("pose")) read_pose(reader, *pose, body);
  if (const auto velocity = node.find("velocity")) body.velocity = reader.coordinates(*velocity);
  if (const auto spin = node.find("angular_velocity")) {
    body.spin = reader.is_spatial() ? reader.coordinates(*spin) : Vector3{0.0, 0.0, spin->number()};
  }
}

/// Bodies with more further items come first: these say most, and nothing of it can be left out.
void lower_bodies(Lowering& scene) {
  std::vector<int> order(scene.draft().bodies.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int x, int y) {
    return scene.draft().body(x).further.size() > scene.draft().body(y).further.size();
  });
  std::vector<bool> is_done(scene.draft().bodies.size(), false);
  for (const int index : order) {
    BodyLowering(scene, index, is_done).run();
    is_done[static_cast<std::size_t>(index)] = true;
  }
}

}  // namespace mbs
