// A sum of coordinates.
#include <fmt/format.h>

#include <cmath>
#include <string_view>
#include <unordered_map>

#include "printable.hpp"
#include "scene/time_functions.hpp"
#include "scene_file/kinds/drivers.hpp"
#include "scene_file/kinds/kinds.hpp"

namespace mbs {
namespace {

DraftConstraint::Term read_term(SceneReader& reader, const JsonNode& node) {
  node.allow_keys({"point", "axis", "coefficient"});
  const JsonNode at = node.get("point");
  const int index = reader.point(at);
  if (reader.draft().point(index).hold != Hold::free) {
    at.fail("the fixed or driven point " + in_quotes(at.text()), "a free point");
  }
  const JsonNode axis = node.get("axis");
  const std::string_view axes =
      std::string_view("xyz").substr(0, static_cast<std::size_t>(reader.draft().dimension));
  const auto found = axes.find(axis.text());
  if (axis.text().size() != 1 || found == std::string_view::npos) {
    axis.fail(reader.is_spatial() ? "\"x\", \"y\" or \"z\"" : "\"x\" or \"y\"");
  }
  const JsonNode coefficient = node.get("coefficient");
  if (coefficient.number() == 0.0) coefficient.fail("a number other than 0");
  reader.use(index);
  return {index, static_cast<int>(found), coefficient.number()};
}

constexpr std::size_t kMostTerms = 10'000;

double norm_of(const std::vector<DraftConstraint::Term>& terms) {
  double norm = 0.0;
  for (const DraftConstraint::Term& term : terms) norm = std::hypot(norm, term.coefficient);
  return norm;
}

}  // namespace

void read_linear(SceneReader& reader, const JsonNode& node, DraftConstraint& constraint) {
  node.allow_keys({"type", "name", "terms", "value"});
  const JsonNode list = node.get("terms");
  const auto nodes = list.items();
  if (nodes.empty() || nodes.size() > kMostTerms) {
    list.fail(fmt::format("an array of 1 to {} terms", kMostTerms));
  }
  std::unordered_map<int, std::string> path_of;  // by point and axis
  for (const JsonNode& item : nodes) {
    const DraftConstraint::Term term = read_term(reader, item);
    const auto [same, is_new] = path_of.emplace(3 * term.point + term.axis, item.path());
    if (!is_new) item.fail("the same coordinate as in " + same->second, "one term a coordinate");
    constraint.terms.push_back(term);
  }
  read_value(reader, constraint);
}

/// To coefficients of length 1, so that what the author multiplied them with changes neither the
/// row's weight in the penalty nor how its violation, then in metres, is judged.
Lowering::Force lower_linear(Lowering& scene, const DraftConstraint& constraint) {
  const double norm = norm_of(constraint.terms);
  double start = 0.0;
  for (const DraftConstraint::Term& term : constraint.terms) {
    start += term.coefficient * scene.position(term.point)[static_cast<std::size_t>(term.axis)];
  }
  std::vector<Lowering::Part> parts;
  for (const DraftConstraint::Term& term : constraint.terms) {
    parts.push_back({scene.index(term.point), term.axis, term.coefficient / norm});
  }
  scene.distinct_linear(constraint.node, constraint.name, parts,
                        combination({{1.0 / norm, constraint.value.value_or(start)}}));
  return {Output::Force::multiplier, {}, {}, {}, 1.0 / norm};  // of Phi as given
}

}  // namespace mbs
