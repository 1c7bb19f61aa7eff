// Lists in the order of the table, what others name first; then names and what they stand for.
#include "scene_file/scene_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "printable.hpp"
#include "scene_file/kinds/kinds.hpp"

namespace mbs {
namespace {

constexpr double kAcross = 1e-12;  // cosine that counts as a right angle

}  // namespace

SceneDraft SceneReader::read() {
  root_.allow_keys({"dimension", "gravity", "parameters", "points", "vectors", "rods", "masses",
                    "mass_matrices", "bodies", "constraints", "springs", "torsion_springs", "force_laws", "torque_laws",
                    "forces", "torques", "assembly", "outputs", "$schema"});
  read_dimension_and_gravity();
  if (!root_.find("bodies")) static_cast<void>(root_.get("points"));
  for (const bool is_named : {true, false}) {
    for (const ListKind& kind : list_kinds()) {
      if (kind.is_named != is_named) continue;
      for (const JsonNode& node : list(kind.key)) kind.read(*this, node);
    }
  }
  if (const auto node = root_.find("assembly")) read_assembly(*node);
  return std::move(draft_);
}

std::vector<JsonNode> SceneReader::list(std::string_view key) const {
  const auto node = root_.find(key);
  return node ? node->items() : std::vector<JsonNode>{};
}

void SceneReader::read_dimension_and_gravity() {
  if (const auto node = root_.find("dimension")) {
    const double dimension = node->number();
    if (dimension != 2.0 && dimension != 3.0) node->fail("2 or 3");
    draft_.dimension = static_cast<int>(dimension);
  }
  if (const auto node = root_.find("gravity")) draft_.gravity = coordinates(*node);
}

void SceneReader::read_assembly(const JsonNode& node) {
  node.allow_keys({"largest_correction"});
  draft_.largest_correction =
      node.get("largest_correction").number_at_least(0.0, "a distance in m of at least 0");
}

bool is_usable_name(std::string_view name) {
  const auto is_bad = [](char c) {
    return c == ',' || c == '"' || c == '\'' || static_cast<unsigned char>(c) < 0x20 || c == 0x7F;
  };
  return !name.empty() && std::string_view("=+-@ ").find(name.front()) == std::string_view::npos &&
         name.back() != ' ' && std::none_of(name.begin(), name.end(), is_bad);
}

int SceneReader::add_name(const JsonNode& node, const std::string& name, bool is_vector) {
  if (!is_usable_name(name)) node.fail(in_quotes(name), kUsableName);
  const int index = static_cast<int>(draft_.points.size());
  const auto [same, is_new] = draft_.index_of.emplace(name, index);
  if (!is_new) {
    node.fail(in_quotes(name), fmt::format("a name of its own ({} has it)",
                                           draft_.point(same->second).node->path()));
  }
  draft_.points.push_back({name, node, is_vector});
  return index;
}

int SceneReader::named(const JsonNode& node) const {
  const auto found = draft_.index_of.find(node.text());
  if (found != draft_.index_of.end()) return found->second;
  std::vector<std::string> names;
  for (const DraftPoint& point : draft_.points) {
    if (!point.is_own) names.push_back(point.name);
  }
  node.fail_name(is_spatial() ? "a point or unit vector" : "a point", names);
}

int SceneReader::point(const JsonNode& node) const {
  const int index = named(node);
  if (draft_.point(index).is_vector) {
    node.fail("the unit vector " + in_quotes(node.text()), "the name of a point");
  }
  return index;
}

int SceneReader::vector(const JsonNode& node) const {
  const int index = named(node);
  if (!draft_.point(index).is_vector) {
    node.fail("the point " + in_quotes(node.text()), "the name of a unit vector");
  }
  return index;
}

int SceneReader::body(const JsonNode& node) const {
  const auto found = draft_.body_of.find(node.text());
  if (found != draft_.body_of.end()) return found->second;
  std::vector<std::string> names;
  for (const DraftBody& body : draft_.bodies) names.push_back(body.name);
  node.fail_name("a body", names);
}

std::pair<int, int> SceneReader::point_pair(const JsonNode& node) const {
  const auto items = node.items();
  if (items.size() != 2) node.fail("an array of two point names");
  const std::pair<int, int> pair(point(items[0]), point(items[1]));
  if (pair.first == pair.second) {
    node.fail("the point " + in_quotes(items[0].text()) + " twice", "two different points");
  }
  return pair;
}

DraftDirection SceneReader::direction(const JsonNode& node) const {
  if (node.is_text()) {
    if (is_spatial()) return {-1, vector(node)};
    node.fail("[\"A\", \"B\"], the direction from one point to another");
  }
  const auto [from, to] = point_pair(node);
  return {from, to};
}

Vector3 SceneReader::coordinates(const JsonNode& node) const {
  const auto numbers = node.numbers(draft_.dimension);
  Vector3 result{};
  std::copy(numbers.begin(), numbers.end(), result.begin());
  return result;
}

Vector3 SceneReader::unit_vector(const JsonNode& node) const {
  const Vector3 given = coordinates(node);
  const double length = std::hypot(given[0], given[1], given[2]);
  if (!(length > 1e-50)) node.fail("a direction of length 0", "a length above 0, which is made 1");
  const Vector3 unit = (1.0 / length) * given;
  return (1.0 / std::hypot(unit[0], unit[1], unit[2])) * unit;
}

std::string SceneReader::element_name(const JsonNode& node) {
  const auto name = node.find("name");
  if (!name) return node.path();
  if (name->text().empty()) name->fail("a name that is not empty");
  const auto [same, is_new] = element_of_.emplace(name->text(), node.path());
  if (!is_new) {
    name->fail(in_quotes(name->text()), fmt::format("a name of its own ({} has it)", same->second));
  }
  return node.path() + ' ' + in_quotes(name->text());
}

void SceneReader::use_between(const JsonNode& node, const std::vector<int>& points) {
  bool any_free = false;
  for (const int index : points) {
    use(index);
    any_free = any_free || draft_.point(index).hold == Hold::free;
  }
  if (!any_free) {
    node.fail("only fixed or driven points", "at least one free point, else it is over-fixed");
  }
  const int body = common_body(draft_, points);
  if (body < 0) return;
  node.fail("points of one body only (" + in_quotes(draft_.body(body).name) +
                "), which holds them together already",
            "points of two bodies, or none such rod or constraint");
}

void SceneReader::use_between(const JsonNode& node, const DraftDirection& first,
                              const DraftDirection& second) {
  std::vector<int> points{first.to, second.to};
  if (first.from >= 0) points.push_back(first.from);
  if (second.from >= 0) points.push_back(second.from);
  use_between(node, points);
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

Vector3 SceneReader::local_of(int body, int point) const {
  const std::vector<DraftBody::Item>& items = draft_.body(body).items;
  return std::find_if(items.begin(), items.end(), [&](const auto& it) { return it.point == point; })
      ->local;
}

int SceneReader::vector_across(int body, const Vector3& along, const Vector3* beside) {
  for (const DraftBody::Item& item : draft_.body(body).items) {
    if (!draft_.point(item.point).is_vector || std::abs(dot(item.local, along)) > kAcross) continue;
    if (beside != nullptr && std::abs(dot(item.local, *beside)) > kAcross) continue;
    use(item.point);
    return item.point;
  }
  const Vector3 local = beside != nullptr ? cross(along, *beside) : any_across(along);
  const int own = add_own(draft_, body, local, true, "n");
  use(own);
  return own;
}

}  // namespace mbs
