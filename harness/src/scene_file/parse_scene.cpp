// A JSON scene: text, then members, then equations, then the whole at its start.
#include <fmt/format.h>

#include <optional>
#include <stdexcept>

#include "printable.hpp"
#include "scene/scene.hpp"
#include "scene_file/body/body_basis.hpp"
#include "scene_file/body/placement.hpp"
#include "scene_file/json_text.hpp"
#include "scene_file/load_scene.hpp"
#include "scene_file/lowering.hpp"
#include "scene_file/parameters.hpp"
#include "scene_file/scene_checks.hpp"
#include "scene_file/scene_reader.hpp"
#include "usage_error.hpp"

namespace mbs {

SceneData parse_scene(std::string_view json, const std::string& where) {
  return read_scene(parse_json(json, where), where);
}

SceneData read_scene(const nlohmann::json& document, const std::string& where, Unused unused) {
  const std::optional<nlohmann::json> numbers = with_numbers(document, where, unused);
  SceneDraft draft = SceneReader(JsonNode(numbers ? *numbers : document, where)).read();
  choose_bases(draft);
  place(draft);
  try {
    Lowered lowered = lower(draft);
    check_scene(lowered, where);
    assemble_start(lowered.data, where);
    finish_start(lowered, where);
    check_mobility(lowered, where);
    return std::move(lowered.data);
  } catch (const std::logic_error& error) {  // from the checks of Model: sums that overflow
    throw UsageError(fmt::format("{}: found numbers too large or too small to calculate with ({})",
                                 printable(where), printable(error.what())));
  }
}

}  // namespace mbs
