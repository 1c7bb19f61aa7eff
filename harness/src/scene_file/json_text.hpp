// JSON text to a JSON value, stricter than nlohmann::json::parse.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace mbs {

inline constexpr std::size_t kDeepestNesting = 32;

/// Parses `text`; // and /* */ comments are allowed. Throws UsageError, prefixed by `where`, with
/// line, column and reason on malformed text, with the path on a key that an object has twice or
/// nesting deeper than kDeepestNesting.
nlohmann::json parse_json(std::string_view text, const std::string& where);

/// `path`.`key`, or `key` at the top: for messages.
std::string path_of_key(const std::string& path, std::string_view key);
/// `path`[`index`].
std::string path_of_item(const std::string& path, std::size_t index);

}  // namespace mbs
