// What a run is asked for.
#include <fmt/format.h>

#include <algorithm>

#include "printable.hpp"
#include "scene/scene_reader.hpp"

namespace mbs {
namespace {

using Kind = Output::Kind;

const std::vector<std::pair<std::string, Kind>>& energies() {
  static const std::vector<std::pair<std::string, Kind>> kEnergies = {
      {"kinetic", Kind::kinetic_energy},
      {"potential", Kind::potential_energy},
      {"total", Kind::total_energy}};
  return kEnergies;
}

const std::vector<std::pair<std::string, Kind>>& kinds() {
  static const std::vector<std::pair<std::string, Kind>> kKinds = {
      {"position", Kind::position},
      {"velocity", Kind::velocity},
      {"acceleration", Kind::acceleration},
      {"angle", Kind::angle},
      {"distance", Kind::distance},
      {"energy", Kind::total_energy},
      {"constraint_force", Kind::constraint_force}};
  return kKinds;
}

}  // namespace

void SceneReader::read_output(const JsonNode& node) {
  node.allow_keys({"name", "position", "velocity", "acceleration", "angle", "axis", "distance",
                   "energy", "constraint_force"});
  const JsonNode name = node.get("name");
  if (!is_usable_name(name.text())) name.fail(kUsableName);
  const auto [same, is_new] = output_of_.emplace(name.text(), node.path());
  if (!is_new) name.fail(fmt::format("a name of its own ({} has it)", same->second));
  DraftOutput output{node, {}, ""};
  output.output.name = name.text();
  int asked = 0;
  for (const auto& [key, kind] : kinds()) {
    const auto value = node.find(key);
    if (!value) continue;
    ++asked;
    output.output.kind = kind;
    read_asked(node, *value, output);
  }
  if (asked != 1) {
    node.fail(fmt::format("{} quantities", asked),
              "one of position, velocity, acceleration, angle, distance, energy, constraint_force");
  }
  const auto axis = node.find("axis");
  if (axis && (output.output.kind != Kind::angle || !is_spatial())) {
    axis->fail("an axis", "one beside an angle in space only");
  }
  draft_.outputs.push_back(std::move(output));
}

void SceneReader::read_asked(const JsonNode& node, const JsonNode& value, DraftOutput& asked) {
  Output& output = asked.output;
  const auto show = [&](const DraftDirection& direction) {
    if (direction.from >= 0) draft_.point(direction.from).is_output = true;
    draft_.point(direction.to).is_output = true;
    return Direction{direction.from, direction.to};
  };
  switch (output.kind) {
    case Kind::position:
    case Kind::velocity:
    case Kind::acceleration:
      output.point = show({-1, named(value)}).to;
      break;
    case Kind::angle: {
      const auto items = value.items();
      if (items.size() != 2) value.fail("an array of two directions");
      output.first = show(direction(items[0]));
      output.second = show(direction(items[1]));
      if (is_spatial()) output.axis = show({-1, vector(node.get("axis"))}).to;
      break;
    }
    case Kind::distance: {
      const auto [a, b] = point_pair(value);
      output.first = show({a, b});
      break;
    }
    case Kind::constraint_force:
      asked.constraint = value.text();
      break;
    case Kind::kinetic_energy:
    case Kind::potential_energy:
    case Kind::total_energy: {
      std::vector<std::string> names;
      for (const auto& [text, kind] : energies()) {
        names.push_back(text);
        if (value.text() == text) {
          output.kind = kind;
          return;
        }
      }
      value.fail_name("an energy", names);
    }
  }
}

}  // namespace mbs
