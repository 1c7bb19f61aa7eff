// What a run is asked for.
#include <fmt/format.h>

#include <algorithm>
#include <unordered_map>

#include "printable.hpp"
#include "scene/output_columns.hpp"
#include "scene_file/kinds/kinds.hpp"

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

void read_asked(SceneReader& reader, const JsonNode& node, const JsonNode& value,
                DraftOutput& asked) {
  Output& output = asked.output;
  const auto show = [&](const DraftDirection& direction) {
    if (direction.from >= 0) reader.draft().point(direction.from).is_output = true;
    reader.draft().point(direction.to).is_output = true;
    return Direction{direction.from, direction.to};
  };
  switch (output.kind) {
    case Kind::position:
    case Kind::velocity:
    case Kind::acceleration:
      output.point = show({-1, reader.named(value)}).to;
      break;
    case Kind::angle: {
      const auto items = value.items();
      if (items.size() != 2) value.fail("an array of two directions");
      output.first = show(reader.direction(items[0]));
      output.second = show(reader.direction(items[1]));
      if (reader.is_spatial()) output.axis = show({-1, reader.vector(node.get("axis"))}).to;
      break;
    }
    case Kind::distance: {
      const auto [a, b] = reader.point_pair(value);
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

/// Of a tension with those of the angles at it.
std::vector<Lowering::Row> rows_of(const Lowering& scene, const Lowering::Force& force) {
  std::vector<Lowering::Row> rows = force.rows;
  if (force.kind != Output::Force::tension) return rows;
  const auto is_along = [&force](const DraftDirection& other) {
    return std::minmax(other.from, other.to) == std::minmax(force.first.from, force.first.to);
  };
  for (const Lowering::Force& torque : scene.torques()) {
    if (!is_along(torque.first) && !is_along(torque.second)) continue;
    rows.insert(rows.end(), torque.rows.begin(), torque.rows.end());
  }
  return rows;
}

/// In a table of all outputs, which starts with the time.
void refuse_same_columns(Lowering& scene) {
  std::unordered_map<std::string, std::string> owner_of{{"t", "the time"}};
  for (std::size_t i = 0; i < scene.draft().outputs.size(); ++i) {
    const JsonNode name = scene.draft().outputs[i].node.get("name");
    for (const std::string& column :
         columns_of(scene.elements().outputs[i], scene.draft().dimension)) {
      const auto [same, is_new] = owner_of.emplace(column, name.path());
      if (is_new) continue;
      name.fail(
          fmt::format("{}, which makes the column {}", in_quotes(name.text()), in_quotes(column)),
          fmt::format("columns of its own ({} has it)", same->second));
    }
  }
}

}  // namespace

void read_output(SceneReader& reader, const JsonNode& node) {
  node.allow_keys({"name", "position", "velocity", "acceleration", "angle", "axis", "distance",
                   "energy", "constraint_force"});
  const JsonNode name = node.get("name");
  if (!is_usable_name(name.text())) name.fail(kUsableName);
  const auto [same, is_new] = reader.draft().output_of.emplace(name.text(), node.path());
  if (!is_new) name.fail(fmt::format("a name of its own ({} has it)", same->second));
  DraftOutput output{node, {}, ""};
  output.output.name = name.text();
  int asked = 0;
  for (const auto& [key, kind] : kinds()) {
    const auto value = node.find(key);
    if (!value) continue;
    ++asked;
    output.output.kind = kind;
    read_asked(reader, node, *value, output);
  }
  if (asked != 1) {
    node.fail(fmt::format("{} quantities", asked),
              "one of position, velocity, acceleration, angle, distance, energy, constraint_force");
  }
  const auto axis = node.find("axis");
  if (axis && (output.output.kind != Kind::angle || !reader.is_spatial())) {
    axis->fail("an axis", "one beside an angle in space only");
  }
  reader.draft().outputs.push_back(std::move(output));
}

void lower_outputs(Lowering& scene) {
  for (const DraftOutput& asked : scene.draft().outputs) {
    Output output = asked.output;
    if (output.kind == Output::Kind::constraint_force) {
      const auto found = scene.forces().find(asked.constraint);
      if (found == scene.forces().end()) {
        std::vector<std::string> names;
        for (const auto& [name, force] : scene.forces()) names.push_back(name);
        std::sort(names.begin(), names.end());
        asked.node.get("constraint_force").fail_name("a rod or constraint", names);
      }
      const Lowering::Force& force = found->second;
      output.force = force.kind;
      for (const Lowering::Row row : rows_of(scene, force)) {
        output.rows.push_back(scene.rows().place(row));
      }
      output.first = {force.first.from, force.first.to};
      output.second = {force.second.from, force.second.to};
      output.factor = force.factor;
    }
    for (int* point : {&output.point, &output.first.from, &output.first.to, &output.second.from,
                       &output.second.to, &output.axis}) {
      if (*point >= 0) *point = scene.element_index(*point);
    }
    scene.elements().outputs.push_back(std::move(output));
  }
  refuse_same_columns(scene);
}

}  // namespace mbs
