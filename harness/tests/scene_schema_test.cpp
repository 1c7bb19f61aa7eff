// The JSON Schema names the keys that the reader takes, all of them and no others.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>
#include <tuple>

#include "scene_file/kinds/kinds.hpp"
#include "support/scene_support.hpp"

namespace mbs {
namespace {

using Keys = std::set<std::string>;

nlohmann::json schema() {
  std::ifstream file(kScenes / "scene.schema.json");
  return nlohmann::json::parse(file);
}

Keys keys_of(const nlohmann::json& object) {
  Keys keys;
  for (const auto& [key, value] : object.at("properties").items()) keys.insert(key);
  return keys;
}

/// The keys that the complaint about the unknown key "?" lists.
Keys keys_taken(const std::string& json) {
  const std::string message = parse_error_of(json);
  const std::string before = "the unknown key \"?\", allowed is ", after = " (the nearest is";
  const auto begin = message.find(before), end = message.find(after);
  EXPECT_TRUE(begin != std::string::npos && end != std::string::npos) << message;
  if (begin == std::string::npos || end == std::string::npos) return {};
  std::istringstream list(message.substr(begin + before.size(), end - begin - before.size()));
  Keys keys;
  for (std::string key; list >> key;) {
    if (key.back() == ',') key.pop_back();
    keys.insert(key);
  }
  return keys;
}

/// A spatial scene with one more list.
std::string with(const std::string& list, const std::string& item) {
  return R"({"dimension": 3, "points": [{"name": "A", "position": [0, 0, 0], "fixed": true},
    {"name": "B", "position": [1, 0, 0]}, {"name": "C", "position": [2, 0, 0]}], ")" +
         list + "\": " + item + "}";
}

TEST(SceneSchema, NamesTheReadersKeys) {
  const nlohmann::json all = schema();
  EXPECT_EQ(keys_taken(R"({"?": 1})"), keys_of(all));
  for (const ListKind& kind : list_kinds()) {
    const std::string key(kind.key), list = R"([{"?": 1}])";
    EXPECT_EQ(all["properties"][key]["items"]["$ref"], std::string("#/$defs/") + kind.schema);
    if (key == "constraints") continue;  // by type: below
    EXPECT_EQ(keys_taken(key == "points" ? R"({"points": )" + list + "}" : with(key, list)),
              keys_of(all["$defs"][kind.schema]))
        << key;
  }
  EXPECT_EQ(keys_taken(with("assembly", R"({"?": 1})")), keys_of(all["properties"]["assembly"]));
}

TEST(SceneSchema, NamesTheKeysOfTables) {
  const nlohmann::json definitions = schema()["$defs"];
  for (const auto& [list, definition, ends] :
       {std::tuple{"force_laws", "force_law", R"("between": ["A", "B"])"},
        std::tuple{"torque_laws", "torque_law",
                   R"("from": ["A", "B"], "to": ["B", "C"], "axis": "z")"}}) {
    for (const auto& [key, table] : definitions[definition]["properties"].items()) {
      if (!key.starts_with("by_")) continue;
      const std::string vectors = R"([{"name": "z", "direction": [0, 0, 1]}], ")";
      EXPECT_EQ(keys_taken(with("vectors", vectors + list + "\": [{" + ends + ", \"" + key +
                                               R"(": {"?": 1}}])")),
                keys_of(table))
          << list << key;
    }
  }
}

TEST(SceneSchema, NamesTheKeysOfConstraintsAndFunctions) {
  const nlohmann::json definitions = schema()["$defs"];
  Keys types, known;
  for (const auto& constraint : definitions["constraint"]["oneOf"]) {
    const std::string type = constraint["properties"]["type"]["const"];
    types.insert(type);
    EXPECT_EQ(
        keys_taken(with("constraints", R"([{"?": 1, "between": ["A", "B"], "points": ["A", "B"],
                                "first": ["A", "B"], "second": ["B", "C"], "type": ")" +
                                           type + "\"}]")),
        keys_of(constraint))
        << type;
  }
  for (const ConstraintKind& kind : constraint_kinds()) known.emplace(kind.type);
  EXPECT_EQ(types, known);
  const std::string distance = R"([{"type": "distance", "between": ["A", "B"], "value": )";
  Keys functions;
  for (const auto& function : definitions["function"]["oneOf"]) {
    if (!function.contains("properties")) continue;
    const Keys kind = keys_of(function);
    functions.insert(kind.begin(), kind.end());
    const nlohmann::json& inner = function["properties"][*kind.begin()];
    if (!inner.contains("properties")) continue;
    EXPECT_EQ(
        keys_taken(with("constraints", distance + "{\"" + *kind.begin() + R"(": {"?": 1}}}])")),
        keys_of(inner));
  }
  EXPECT_EQ(keys_taken(with("constraints", distance + R"({"?": 1}}])")), functions);
}

}  // namespace
}  // namespace mbs
