// A JSON scene: text, then members, then the whole.
#include "scene/json_text.hpp"
#include "scene/scene.hpp"
#include "scene/scene_checks.hpp"
#include "scene/scene_reader.hpp"

namespace mbs {

ModelData parse_scene(std::string_view json, const std::string& where) {
  const nlohmann::json root = parse_json(json, where);
  ModelData data = SceneReader(JsonNode(root, where)).read();
  check_scene(data, where);
  return data;
}

}  // namespace mbs
