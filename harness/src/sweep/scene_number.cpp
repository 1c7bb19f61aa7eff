// One step along the path at a time; whoever is lost is told where the path ends and what goes on.
#include "sweep/scene_number.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <charconv>
#include <optional>
#include <string_view>
#include <vector>

#include "printable.hpp"
#include "scene_file/parameters.hpp"
#include "sweep/value_range.hpp"

namespace mbs {
namespace {

using nlohmann::json;

/// "~1" is "/", "~0" is "~", as in JSON pointers.
std::string unescaped(std::string_view token) {
  std::string result;
  for (std::size_t i = 0; i < token.size(); ++i) {
    const bool escape = token[i] == '~' && i + 1 < token.size();
    if (escape && (token[i + 1] == '0' || token[i + 1] == '1')) {
      result += token[++i] == '0' ? '~' : '/';
    } else {
      result += token[i];
    }
  }
  return result;
}

std::vector<std::string> tokens_of(std::string_view path) {
  std::vector<std::string> tokens;
  for (std::size_t begin = 0; begin <= path.size();) {
    const std::size_t end = std::min(path.find('/', begin), path.size());
    tokens.push_back(unescaped(path.substr(begin, end - begin)));
    begin = end + 1;
  }
  return tokens;
}

/// Empty if it has none.
std::string name_of_item(const json& item) {
  if (!item.is_object()) return "";
  for (const char* key : {"name", "point"}) {
    const auto found = item.find(key);
    if (found != item.end() && found->is_string()) return found->get<std::string>();
  }
  const auto ends = item.find("between");
  const bool has_ends = ends != item.end() && ends->is_array() && ends->size() == 2 &&
                        (*ends)[0].is_string() && (*ends)[1].is_string();
  return has_ends ? (*ends)[0].get<std::string>() + "-" + (*ends)[1].get<std::string>() : "";
}

/// What can follow, for people: names, or else indices.
std::string members_of(const json& value) {
  constexpr std::size_t kShown = 12;
  std::vector<std::string> names;
  std::size_t known = 0;
  for (const auto& [key, member] : value.items()) {
    const std::string name = value.is_object() ? key : name_of_item(member);
    if (name.empty()) continue;
    if (++known <= kShown) names.push_back(printable(name));
  }
  if (known > kShown) names.emplace_back("...");
  const std::string indices =
      value.size() == 1 ? "the index 0"
                        : fmt::format("an index from 0 to {}", std::ptrdiff_t(value.size()) - 1);
  if (value.empty()) return "nothing: it is empty";
  if (value.is_object()) {
    return fmt::format("one of {} (what is left out must be written there first)",
                       fmt::join(names, ", "));
  }
  if (names.empty()) return indices;
  return fmt::format("one of {}, or {}", fmt::join(names, ", "), indices);
}

std::string kind_of(const json& value) {
  if (value.is_object()) return "an object";
  if (value.is_array()) return fmt::format("an array of {}", value.size());
  if (value.is_string()) return "the text " + in_quotes(value.get_ref<const std::string&>());
  return value.dump();
}

/// The item of an array that `token` names, or whose index it is.
std::optional<std::size_t> find_item(const json& array, const std::string& token,
                                     const std::string& path) {
  std::optional<std::size_t> found;
  for (std::size_t i = 0; i < array.size() && !token.empty(); ++i) {
    if (name_of_item(array[i]) != token) continue;
    if (found) {
      refuse_vary(path, fmt::format("{} twice, as items {} and {}", in_quotes(token), *found, i),
                  "a name that one item has, or an index");
    }
    found = i;
  }
  if (found) return found;
  std::size_t index = 0;
  const char* end = token.data() + token.size();
  const auto [stop, error] = std::from_chars(token.data(), end, index);
  if (error != std::errc{} || stop != end || index >= array.size()) return std::nullopt;
  return index;
}

}  // namespace

json::json_pointer find_number(const json& document, const std::string& path) {
  const auto parameters = document.find("parameters");
  if (parameters != document.end() && parameters->is_object() && parameters->contains(path)) {
    return json::json_pointer("/parameters") / path;
  }
  json::json_pointer pointer;
  const json* at = &document;
  for (const std::string& token : tokens_of(path)) {
    const std::string where = pointer.empty() ? "the scene" : pointer.to_string().substr(1);
    const auto unknown = [&] {
      refuse_vary(path, fmt::format("no {} in {}", in_quotes(token), printable(where)),
                  members_of(*at));
    };
    if (at->is_object()) {
      if (!at->contains(token)) unknown();
      pointer.push_back(token);
    } else if (at->is_array()) {
      const auto index = find_item(*at, token, path);
      if (!index) unknown();
      pointer.push_back(std::to_string(*index));
    } else {
      refuse_vary(path,
                  fmt::format("{} in {}, and nothing below it", kind_of(*at), printable(where)),
                  "a path that ends at a number");
    }
    at = &document.at(pointer);
  }
  if (!at->is_number() && !is_expression(*at)) {
    refuse_vary(path, kind_of(*at),
                at->is_structured() && !at->empty() ? "a number: go on with " + members_of(*at)
                                                    : "a number");
  }
  return pointer;
}

}  // namespace mbs
