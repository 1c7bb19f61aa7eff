// Reading order: dimension, gravity, points, rods, masses, constraints.
#include "scene/scene_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "printable.hpp"
#include "scene/bodies.hpp"

namespace mbs {
namespace {

constexpr double kLengthTolerance = 1e-9;  // relative
constexpr std::size_t kMostTerms = 10'000;
constexpr std::string_view kAxes = "xyz";

double dot(const std::array<double, 3>& x, const std::array<double, 3>& y) {
  return x[0] * y[0] + x[1] * y[1] + x[2] * y[2];
}

/// Names become column prefixes of a CSV file.
bool is_usable_name(std::string_view name) {
  const auto is_bad = [](char c) {
    return c == ',' || c == '"' || c == '\'' || static_cast<unsigned char>(c) < 0x20 || c == 0x7F;
  };
  return !name.empty() && name.front() != ' ' && name.back() != ' ' &&
         std::none_of(name.begin(), name.end(), is_bad);
}

/// How messages call a rod or constraint: "rods[0]", or with its own name, "rods[0] "crank"".
std::string label(const JsonNode& node) {
  const auto name = node.find("name");
  return name ? node.path() + ' ' + in_quotes(name->text()) : node.path();
}

}  // namespace

ModelData SceneReader::read() {
  root_.allow_keys({"dimension", "gravity", "points", "rods", "masses", "constraints"});
  read_dimension_and_gravity();
  for (const JsonNode& node : root_.get("points").items()) read_point(node);
  start_bodies(data_);
  for (const JsonNode& node : list("rods")) read_rod(node);
  for (const JsonNode& node : list("masses")) read_mass(node);
  for (const JsonNode& node : list("constraints")) read_constraint(node);
  return std::move(data_);
}

std::vector<JsonNode> SceneReader::list(std::string_view key) const {
  const auto node = root_.find(key);
  return node ? node->items() : std::vector<JsonNode>{};
}

void SceneReader::read_dimension_and_gravity() {
  if (const auto node = root_.find("dimension")) {
    const double dimension = node->number();
    if (dimension != 2.0 && dimension != 3.0) node->fail("2 or 3");
    data_.dimension = static_cast<int>(dimension);
  }
  if (const auto node = root_.find("gravity")) gravity_ = vector(*node);
}

void SceneReader::read_point(const JsonNode& node) {
  node.allow_keys({"name", "position", "velocity", "fixed"});
  const JsonNode name = node.get("name");
  if (!is_usable_name(name.text())) {
    name.fail("a name without comma, quotation mark, control character or blank at its ends");
  }
  const int index = static_cast<int>(data_.points.size());
  const auto [same, is_new] = index_of_.emplace(name.text(), index);
  if (!is_new) {
    name.fail(in_quotes(name.text()),
              fmt::format("a name of its own (points[{}] has it)", same->second));
  }
  const auto fixed = node.find("fixed");
  const bool is_fixed = fixed && fixed->boolean();
  const auto velocity_node = node.find("velocity");
  const auto velocity = velocity_node ? vector(*velocity_node) : std::array<double, 3>{};
  if (is_fixed && velocity != std::array<double, 3>{}) {
    velocity_node->fail("a moving fixed point", "zero, or a point that is not fixed");
  }
  data_.points.push_back({name.text(), is_fixed ? -1 : variables_, vector(node.get("position"))});
  if (is_fixed) return;
  variables_ += data_.dimension;
  data_.initial_velocity.insert(data_.initial_velocity.end(), velocity.begin(),
                                velocity.begin() + data_.dimension);
}

void SceneReader::read_rod(const JsonNode& node) {
  node.allow_keys({"name", "between", "mass", "length"});
  const JsonNode between = node.get("between");
  const auto ends = point_pair(between);
  if (is_fixed(ends)) {
    between.fail("two fixed points", "at least one free point, else the rod is over-fixed");
  }
  const JsonNode mass = node.get("mass");
  if (!(mass.number() >= 0.0)) mass.fail("a mass in kg of at least 0 (0: massless)");
  const auto along = difference(ends);
  double squared_length = dot(along, along);
  const double distance = std::hypot(along[0], along[1], along[2]);
  if (!(squared_length > 0.0)) {
    between.fail("a rod of length 0 (its points start at the same place)", "a length above 0");
  }
  if (const auto length = node.find("length")) {
    if (!(length->number() > 0.0)) length->fail("a length in m above 0");
    const double error = std::abs(length->number() - distance);
    if (!(error <= kLengthTolerance * std::max(length->number(), distance))) {
      length->fail(
          fmt::format("{}, but {} and {} start {} apart", length->number(),
                      in_quotes(point(ends.first).name), in_quotes(point(ends.second).name),
                      distance),
          fmt::format("their distance to {:g} of it (or no \"length\")", kLengthTolerance));
    }
    squared_length = length->number() * length->number();
  }
  refuse_same_dot(node, ends, ends);
  add_rod(data_, {ends.first, ends.second, mass.number(), squared_length, label(node)}, gravity_);
}

void SceneReader::read_mass(const JsonNode& node) {
  node.allow_keys({"point", "mass"});
  const JsonNode at = node.get("point");
  const int index = point_index(at);
  if (point(index).is_fixed()) at.fail("the fixed point " + in_quotes(at.text()), "a free point");
  const JsonNode mass = node.get("mass");
  if (!(mass.number() > 0.0)) mass.fail("a mass in kg above 0");
  add_point_mass(data_, index, mass.number(), gravity_);
}

void SceneReader::read_constraint(const JsonNode& node) {
  node.allow_keys({"type", "name", "first", "second", "terms", "value"});
  const JsonNode type = node.get("type");
  if (type.text() == "dot") {
    read_dot(node);
  } else if (type.text() == "linear") {
    read_linear(node);
  } else {
    type.fail("\"dot\" or \"linear\"");
  }
}

void SceneReader::read_dot(const JsonNode& node) {
  node.allow_keys({"type", "name", "first", "second", "value"});
  const auto first = point_pair(node.get("first"));
  const auto second = point_pair(node.get("second"));
  if (is_fixed(first) && is_fixed(second)) {
    node.fail("only fixed points", "at least one free point, else it is over-fixed");
  }
  const auto along_first = difference(first);
  const auto along_second = difference(second);
  if (!(dot(along_first, along_first) > 0.0 || dot(along_second, along_second) > 0.0)) {
    node.fail("two differences of length 0 at the start", "at most one");
  }
  refuse_same_dot(node, first, second);
  const auto value = node.find("value");
  data_.dot_constraints.push_back({first.first, first.second, second.first, second.second,
                                   value ? value->number() : dot(along_first, along_second),
                                   label(node)});
}

void SceneReader::read_linear(const JsonNode& node) {
  node.allow_keys({"type", "name", "terms", "value"});
  const JsonNode list = node.get("terms");
  const auto nodes = list.items();
  if (nodes.empty() || nodes.size() > kMostTerms) {
    list.fail(fmt::format("an array of 1 to {} terms", kMostTerms));
  }
  Terms terms;
  std::map<int, std::string> path_of;  // by coordinate
  double initial = 0.0;
  for (const JsonNode& item : nodes) {
    terms.push_back(read_term(item));
    const auto [same, is_new] = path_of.emplace(terms.back().coordinate, item.path());
    if (!is_new) item.fail("the same coordinate as in " + same->second, "one term a coordinate");
    const Point& owner = point(point_index(item.get("point")));
    initial += terms.back().coefficient *
               owner.position[static_cast<std::size_t>(terms.back().coordinate - owner.offset)];
  }
  refuse_same_linear(node, terms);
  const auto value = node.find("value");
  // To unit length: the penalty weighs all constraints alike, and violations are judged in metres.
  double norm = 0.0;
  for (const LinearConstraint::Term& term : terms) norm = std::hypot(norm, term.coefficient);
  for (LinearConstraint::Term& term : terms) term.coefficient /= norm;
  data_.linear_constraints.push_back(
      {std::move(terms), (value ? value->number() : initial) / norm, label(node)});
}

LinearConstraint::Term SceneReader::read_term(const JsonNode& node) const {
  node.allow_keys({"point", "axis", "coefficient"});
  const JsonNode at = node.get("point");
  const Point& owner = point(point_index(at));
  if (owner.is_fixed()) at.fail("the fixed point " + in_quotes(at.text()), "a free point");
  const JsonNode axis = node.get("axis");
  const std::string_view axes = kAxes.substr(0, static_cast<std::size_t>(data_.dimension));
  const auto found = axes.find(axis.text());
  if (axis.text().size() != 1 || found == std::string_view::npos) {
    axis.fail(data_.dimension == 2 ? "\"x\" or \"y\"" : "\"x\", \"y\" or \"z\"");
  }
  const JsonNode coefficient = node.get("coefficient");
  if (coefficient.number() == 0.0) coefficient.fail("a number other than 0");
  return {owner.offset + static_cast<int>(found), coefficient.number()};
}

std::array<double, 3> SceneReader::vector(const JsonNode& node) const {
  const auto numbers = node.numbers(data_.dimension);
  std::array<double, 3> result{};
  std::copy(numbers.begin(), numbers.end(), result.begin());
  return result;
}

int SceneReader::point_index(const JsonNode& node) const {
  const auto found = index_of_.find(node.text());
  if (found != index_of_.end()) return found->second;
  constexpr std::size_t kShown = 8;
  std::string names;
  for (std::size_t i = 0; i < std::min(kShown, data_.points.size()); ++i) {
    names += (i == 0 ? "" : ", ") + printable(data_.points[i].name);
  }
  if (data_.points.size() > kShown) names += ", ...";
  node.fail(in_quotes(node.text()), "the name of a point (" + names + ")");
}

std::pair<int, int> SceneReader::point_pair(const JsonNode& node) const {
  const auto items = node.items();
  if (items.size() != 2) node.fail("an array of two point names");
  const std::pair<int, int> pair(point_index(items[0]), point_index(items[1]));
  if (pair.first == pair.second) {
    node.fail("the point " + in_quotes(items[0].text()) + " twice", "two different points");
  }
  return pair;
}

std::array<double, 3> SceneReader::difference(std::pair<int, int> pair) const {
  std::array<double, 3> result{};
  for (std::size_t axis = 0; axis < result.size(); ++axis) {
    result[axis] = point(pair.first).position[axis] - point(pair.second).position[axis];
  }
  return result;
}

void SceneReader::refuse_same_dot(const JsonNode& node, std::pair<int, int> first,
                                  std::pair<int, int> second) {
  // Orders within and of the pairs change at most the sign.
  std::pair<int, int> x = std::minmax(first.first, first.second);
  std::pair<int, int> y = std::minmax(second.first, second.second);
  if (y < x) std::swap(x, y);
  const auto [same, is_new] =
      dots_.emplace(std::array<int, 4>{x.first, x.second, y.first, y.second}, node.path());
  if (!is_new) {
    node.fail("the same points as in " + same->second,
              "one rod or constraint between the same points, another is redundant");
  }
}

void SceneReader::refuse_same_linear(const JsonNode& node, Terms terms) {
  std::sort(terms.begin(), terms.end(),
            [](const auto& x, const auto& y) { return x.coordinate < y.coordinate; });
  std::vector<std::pair<int, double>> scaled;
  for (const auto& term : terms) {
    scaled.emplace_back(term.coordinate, term.coefficient / terms.front().coefficient);
  }
  const auto [same, is_new] = linears_.emplace(std::move(scaled), node.path());
  if (!is_new) {
    node.fail("the same coefficients as in " + same->second + " or a multiple",
              "one such constraint, another is redundant");
  }
}

}  // namespace mbs
