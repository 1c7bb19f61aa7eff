// From what the user typed, or a JSON document, to a scene.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "scene/scene.hpp"

namespace mbs {

/// Reads "four-bar:N", "four-bar:N,fill=F", a scene of a family ("ladder:12", scene_families()) or
/// the path of a JSON scene (harness/scenes/README.md has the format). Throws UsageError.
Scene load_scene(const std::string& text);

/// Parses the text of a JSON scene, assembles its start and checks it, physically too; `where`
/// names it in errors. A Model made from the result is valid. Throws UsageError.
SceneData parse_scene(std::string_view json, const std::string& where);

/// The document of "four-bar:N" (with neither the exact motion nor artificial fill), of a family's
/// scene or of the JSON file at a path. Throws UsageError.
nlohmann::json load_document(const std::string& text);

/// A parameter that no expression names: a mistake of who wrote the document; but a number that took
/// an expression's place since may leave one.
enum class Unused { refused, allowed };

/// The scene that a document says; `name` is what it is called, in errors too. Throws UsageError.
Scene scene_of(const nlohmann::json& document, const std::string& name,
               Unused unused = Unused::refused);

/// The same points, rods, velocities and outputs as four_bar() and four_bar_elements().
nlohmann::json four_bar_document(int loops);

/// parse_scene() of what is parsed already.
SceneData read_scene(const nlohmann::json& document, const std::string& where,
                     Unused unused = Unused::refused);

}  // namespace mbs
