// The table of families and the reader of their names. A new one is a function, its line in the
// table, its row in README.md and a test.
#include "scene/families/families.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <nlohmann/json.hpp>

#include "printable.hpp"
#include "usage_error.hpp"

namespace mbs {

using FamilyDocument = nlohmann::json(const FamilyValues&);
using FamilySize = SceneSize(const FamilyValues&);

FamilyDocument chain_document, loop_document, tree_document, ladder_document, grid_document,
    cloth_document, truss_document, scissors_document, bodies_document, vehicle_document,
    robot_document, star_document, clusters_document, flexible_document;
FamilySize chain_size, loop_size, tree_size, ladder_size, grid_size, cloth_size, truss_size,
    scissors_size, bodies_size, vehicle_size, robot_size, star_size, clusters_size, flexible_size;

std::span<const SceneFamily> scene_families() {
  static const FamilyParameter kDimension{"dimension", "D", 2, 3, 2};
  static const std::vector<SceneFamily> kFamilies = {
      {"chain",
       "anchor chain: N links hang from a support and swing",
       {{"N", "N", 1, 20'000}, kDimension},
       chain_size,
       chain_document},
      {"loop",
       "festoon: N links between two supports",
       {{"N", "N", 4, 20'001}},
       loop_size,
       loop_document},
      {"tree",
       "mobile: N rods, each with two below it",
       {{"N", "N", 1, 20'000}},
       tree_size,
       tree_document},
      {"ladder", "rope ladder of N rungs", {{"N", "N", 1, 10'000}}, ladder_size, ladder_document},
      {"grid",
       "cargo net of N by M meshes, hung at its upper edge; spatial",
       {{"N", "N", 1, 5'000}, {"M", "M", 1, 5'000}},
       grid_size,
       grid_document},
      {"cloth",
       "stretch fabric: M threads of N rods, hung side by side, springs across them; spatial",
       {{"N", "N", 1, 4'000}, {"M", "M", 3, 5'000}},
       cloth_size,
       cloth_document},
      {"truss",
       "folding crane boom: N hinged lattices of K bays, redundantly braced",
       {{"N", "N", 1, 6'666}, {"bays", "K", 1, 20, 8}},
       truss_size,
       truss_document},
      {"scissors",
       "scissor gate of N stages on springs, lying flat",
       {{"N", "N", 1, 6'666}},
       scissors_size,
       scissors_document},
      {"bodies",
       "snake arm: N rigid bodies, each hinged to the one before",
       {{"N", "N", 1, 20'000}, kDimension},
       bodies_size,
       bodies_document},
      {"vehicle",
       "heavy transporter: N axles with springs and dampers on a wavy road",
       {{"N", "N", 2, 6'666}},
       vehicle_size,
       vehicle_document},
      {"robot",
       "walking platform on N sprung legs, N even; spatial",
       {{"N", "N", 6, 6'666}},
       robot_size,
       robot_document},
      {"star",
       "flail: N blades hinged to one rotor",
       {{"N", "N", 2, 10'000}},
       star_size,
       star_document},
      {"clusters",
       "floating bridge: N soft pontoons of K points, joined by chains",
       {{"N", "N", 2, 5'000}, {"size", "K", 3, 60, 6}},
       clusters_size,
       clusters_document},
      {"flexible",
       "flexible arm: N beams of K nodes and a full mass matrix each, hinged end to end",
       {{"N", "N", 1, 10'000}, {"nodes", "K", 3, 100, 8}},
       flexible_size,
       flexible_document},
  };
  return kFamilies;
}

namespace {

constexpr int kNotGiven = 0;  // no parameter may be that

[[noreturn]] void refuse_name(const std::string& scene, const std::string& what) {
  throw UsageError(fmt::format("scene {}: {}", in_quotes(scene), what));
}

const SceneFamily* find_family(std::string_view text) {
  const auto colon = text.find(':');
  if (colon == std::string_view::npos) return nullptr;
  const auto found = std::ranges::find(scene_families(), text.substr(0, colon), &SceneFamily::name);
  return found == scene_families().end() ? nullptr : &*found;
}

std::vector<std::string_view> parts_of(std::string_view text, char at) {
  std::vector<std::string_view> parts;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(at, begin), text.size());
    parts.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return parts;
}

std::size_t count_sizes(const SceneFamily& family) {
  return static_cast<std::size_t>(std::ranges::count_if(
      family.parameters, [](const FamilyParameter& one) { return !one.otherwise; }));
}

/// What stands before the first comma.
void read_sizes(const std::string& scene, const SceneFamily& family, std::string_view text,
                FamilyValues& values) {
  const std::vector<std::string_view> parts = parts_of(text, 'x');
  if (parts.size() != count_sizes(family)) {
    refuse_name(scene, fmt::format("found {} as its size, allowed is {} ({})", in_quotes(text),
                                   family.form(), family.ranges()));
  }
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const FamilyParameter& one = family.parameters[i];
    values[i] = parse_whole(scene, parts[i], one.name, one.least, one.most);
  }
}

void read_option(const std::string& scene, const SceneFamily& family, std::string_view text,
                 FamilyValues& values) {
  const std::string_view key = text.substr(0, text.find('='));
  for (std::size_t i = count_sizes(family); i < family.parameters.size(); ++i) {
    const FamilyParameter& one = family.parameters[i];
    if (key != one.name || key.size() == text.size()) continue;
    if (values[i] != kNotGiven) {
      refuse_name(scene, fmt::format("found the option {} twice, allowed is once", key));
    }
    values[i] = parse_whole(scene, text.substr(key.size() + 1), one.name, one.least, one.most);
    return;
  }
  refuse_name(scene, fmt::format("found the option {}, allowed is {} ({})", in_quotes(text),
                                 family.form(), family.ranges()));
}

}  // namespace

std::string SceneFamily::form() const {
  std::string sizes, options;
  for (const FamilyParameter& one : parameters) {
    if (one.otherwise) {
      options += fmt::format("[,{}={}]", one.name, one.symbol);
    } else {
      sizes += (sizes.empty() ? "" : "x") + std::string(one.name);
    }
  }
  return fmt::format("{}:{}{}", name, sizes, options);
}

std::string SceneFamily::ranges() const {
  std::vector<std::string> texts;
  for (const FamilyParameter& one : parameters) {
    texts.push_back(fmt::format("{} from {} to {}", one.name, one.least, one.most));
    if (one.otherwise) texts.back() += fmt::format(", {} if left out", *one.otherwise);
  }
  return fmt::format("{}", fmt::join(texts, "; "));
}

bool is_family_scene(std::string_view text) { return find_family(text) != nullptr; }

nlohmann::json family_document(const std::string& text) {
  const SceneFamily& family = *find_family(text);
  const std::string_view rest =
      std::string_view(text).substr(std::string_view(family.name).size() + 1);
  FamilyValues values(family.parameters.size(), kNotGiven);
  const std::vector<std::string_view> parts = parts_of(rest, ',');
  read_sizes(text, family, parts[0], values);
  for (std::size_t i = 1; i < parts.size(); ++i) read_option(text, family, parts[i], values);
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (values[i] == kNotGiven) values[i] = *family.parameters[i].otherwise;
  }
  const long variables = family.size(values).variables;
  if (variables > kMostFamilyVariables) {
    refuse_name(text, fmt::format("found {} variables, allowed are at most {}", variables,
                                  kMostFamilyVariables));
  }
  return family.document(values);
}

int parse_whole(const std::string& scene, std::string_view text, const char* parameter, int least,
                int most) {
  int value = 0;
  const bool digits =
      !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos;
  const auto error = std::from_chars(text.data(), text.data() + text.size(), value).ec;
  if (!digits || text[0] == '0' || error != std::errc{} || value < least || value > most) {
    refuse_name(
        scene,
        fmt::format(
            "found {} for {}, allowed is a whole number from {} to {} without sign or leading 0",
            in_quotes(text), parameter, least, most));
  }
  return value;
}

}  // namespace mbs
