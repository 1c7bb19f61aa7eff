// Laws of forces and torques: tables over a length or angle and over its rate.
#include <fmt/format.h>

#include <cmath>

#include "model_math/monotone_curve.hpp"
#include "scene_file/kinds/drivers.hpp"
#include "scene_file/kinds/kinds.hpp"

namespace mbs {
namespace {

constexpr std::size_t kFewestLawRows = 2;

/// {"lengths": [...], "forces": [...]} and the like.
Curve read_curve(const JsonNode& node, const std::string& arguments, const std::string& values) {
  node.allow_keys({arguments, values});
  const JsonNode x_node = node.get(arguments), y_node = node.get(values);
  const std::vector<double> x = x_node.numbers(), y = y_node.numbers();
  if (x.size() < kFewestLawRows) {
    x_node.fail(fmt::format("{} of {}", x.size(), arguments),
                fmt::format("at least {}", kFewestLawRows));
  }
  if (y.size() != x.size()) {
    y_node.fail(fmt::format("{} {} for {} {}", y.size(), values, x.size(), arguments),
                "as many of one as of the other");
  }
  const auto rows = x_node.items();
  for (std::size_t i = 1; i < x.size(); ++i) {
    if (!(x[i] > x[i - 1]))
      rows[i].fail(fmt::format("a number above the one before, {}", x[i - 1]));
  }
  Curve curve = monotone_curve(x, y);
  for (std::size_t i = 0; i < curve.pieces.size(); ++i) {
    for (const double c : curve.pieces[i].coefficients) {
      if (std::isfinite(c)) continue;
      rows[i].fail("rows so close together that the slope between them is not finite",
                   "rows further apart");
    }
  }
  return curve;
}

/// A law over `position` ("length" or "angle"), whose tables have a column of `values`.
Law read_law(SceneReader& reader, const JsonNode& node, const std::string& position,
             const std::string& values) {
  const auto by_position = node.find("by_" + position), by_rate = node.find("by_rate");
  if (!by_position && !by_rate) {
    node.fail("a law without a table", fmt::format("by_{}, by_rate or both", position));
  }
  Law law;
  if (by_position) law.by_position = read_curve(*by_position, position + "s", values);
  if (by_rate) law.by_rate = read_curve(*by_rate, "rates", values);
  if (const auto factor = node.find("factor")) {
    law.factor = read_driver(reader, *factor, "without unit");
  }
  return law;
}

}  // namespace

void read_force_law(SceneReader& reader, const JsonNode& node) {
  node.allow_keys({"name", "between", "by_length", "by_rate", "factor"});
  const JsonNode between = node.get("between");
  const auto [a, b] = reader.point_pair(between);
  reader.use_between(between, {a, b});
  DraftForceLaw law{node, reader.element_name(node), a, b};
  law.law = read_law(reader, node, "length", "forces");
  reader.draft().force_laws.push_back(std::move(law));
}

void lower_force_laws(Lowering& scene) {
  for (const DraftForceLaw& law : scene.draft().force_laws) {
    scene.model().force_laws.push_back({scene.index(law.a), scene.index(law.b), law.law, law.name});
  }
}

void read_torque_law(SceneReader& reader, const JsonNode& node) {
  node.allow_keys({"name", "from", "to", "axis", "by_angle", "by_rate", "factor"});
  DraftTorqueLaw law{node, reader.element_name(node), reader.direction(node.get("from")),
                     reader.direction(node.get("to"))};
  reader.use_between(node, law.from, law.to);
  law.axis = reader.axis(node);
  law.law = read_law(reader, node, "angle", "torques");
  reader.draft().torque_laws.push_back(std::move(law));
}

void lower_torque_laws(Lowering& scene) {
  for (const DraftTorqueLaw& law : scene.draft().torque_laws) {
    const Lowering::Edge from = scene.edge(law.from), to = scene.edge(law.to);
    scene.model().torque_laws.push_back({from.a, from.b, to.a, to.b,
                                         law.axis < 0 ? -1 : scene.index(law.axis), law.law,
                                         law.name});
  }
}

}  // namespace mbs
