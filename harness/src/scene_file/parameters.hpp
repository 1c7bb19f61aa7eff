// Numbers that a scene writes as expressions of its parameters: "=2*k".
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "scene_file/load_scene.hpp"

namespace mbs {

/// The document with the number in place of every text that begins with "=". An expression may have
/// names of "parameters" (numbers or expressions), "pi" and the functions and operators of muParser.
/// Nothing where the document has neither, and is what it says. `where` names it in errors. Throws
/// UsageError: an unknown name, a parameter that depends on itself or (Unused) that nothing uses, a
/// value that is not finite, wrong syntax.
std::optional<nlohmann::json> with_numbers(const nlohmann::json& document, const std::string& where,
                                           Unused unused);

/// Names of the parameters that nothing of the document leads to, of one that with_numbers() takes
/// but for the values of its numbers.
std::vector<std::string> unused_parameters(const nlohmann::json& document,
                                           const std::string& where);

/// Whether a number may be written so.
bool is_expression(const nlohmann::json& value);

}  // namespace mbs
