// Names and what they stand for.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "printable.hpp"
#include "scene/scene_reader.hpp"

namespace mbs {

bool is_usable_name(std::string_view name) {
  const auto is_bad = [](char c) {
    return c == ',' || c == '"' || c == '\'' || static_cast<unsigned char>(c) < 0x20 || c == 0x7F;
  };
  return !name.empty() && name.front() != ' ' && name.back() != ' ' &&
         std::none_of(name.begin(), name.end(), is_bad);
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
  const auto found = body_of_.find(node.text());
  if (found != body_of_.end()) return found->second;
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

}  // namespace mbs
