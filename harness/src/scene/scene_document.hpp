// A scene as the JSON document that says it, for whoever changes numbers in it.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "scene/scene.hpp"

namespace mbs {

/// The document of "four-bar:N" (with neither the exact motion nor artificial fill) or of the JSON
/// file at a path. Throws UsageError.
nlohmann::json load_document(const std::string& text);

/// The scene that a document says; `name` is what it is called, in errors too. Throws UsageError.
Scene scene_of(const nlohmann::json& document, const std::string& name);

/// The same points, rods, velocities and outputs as four_bar() and four_bar_elements().
nlohmann::json four_bar_document(int loops);

/// parse_scene() of what is parsed already.
SceneData read_scene(const nlohmann::json& document, const std::string& where);

}  // namespace mbs
