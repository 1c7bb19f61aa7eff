// Typed access with complaints.
#include "scene_file/json_node.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "printable.hpp"
#include "scene_file/json_text.hpp"
#include "usage_error.hpp"

namespace mbs {
namespace {

constexpr std::size_t kCompared = 64;  // bytes of a name, for the nearest known one

std::string description(const nlohmann::json& value) {
  if (value.is_object()) return "an object";
  if (value.is_array()) return fmt::format("an array of {}", value.size());
  if (value.is_string()) return in_quotes(value.get_ref<const std::string&>());
  return value.dump();
}

bool is_usable(const nlohmann::json& value) {
  return value.is_number() && std::abs(value.get<double>()) <= kLargestNumber;
}

/// Levenshtein distance.
std::size_t distance(std::string_view x, std::string_view y) {
  std::vector<std::size_t> row(y.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < x.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < y.size(); ++j) {
      const std::size_t replace = diagonal + (x[i] == y[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({row[j] + 1, diagonal + 1, replace});
    }
  }
  return row.back();
}

}  // namespace

void JsonNode::fail(const std::string& found, const std::string& allowed) const {
  throw UsageError(fmt::format("{}: {}: found {}, allowed is {}", printable(*file_),
                               path_.empty() ? "top level" : path_, found, allowed));
}

void JsonNode::fail(const std::string& allowed) const { fail(description(*value_), allowed); }

void JsonNode::fail_name(const std::string& what, const std::vector<std::string>& names) const {
  constexpr std::size_t kShown = 8;
  const std::string_view start = std::string_view(text()).substr(0, kCompared);
  std::string shown;
  const std::string* nearest = nullptr;
  std::size_t least = 0;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i < kShown) shown += (i == 0 ? "" : ", ") + printable(names[i]);
    const std::size_t away = distance(start, std::string_view(names[i]).substr(0, kCompared));
    if (nearest != nullptr && away >= least) continue;
    nearest = &names[i];
    least = away;
  }
  if (names.size() > kShown) shown += ", ...";
  fail(in_quotes(text()), nearest == nullptr
                              ? fmt::format("the name of {}, of which there is none", what)
                              : fmt::format("the name of {} ({}); the nearest is {}", what, shown,
                                            in_quotes(*nearest)));
}

void JsonNode::allow_keys(std::initializer_list<std::string_view> known) const {
  if (!value_->is_object()) fail("an object");
  for (const auto& [key, value] : value_->items()) {
    if (std::find(known.begin(), known.end(), key) != known.end()) continue;
    const std::string_view start = std::string_view(key).substr(0, kCompared);
    const auto nearest = std::min_element(known.begin(), known.end(), [&](auto x, auto y) {
      return distance(start, x) < distance(start, y);
    });
    fail("the unknown key " + in_quotes(key),
         fmt::format("{} (the nearest is \"{}\")", fmt::join(known, ", "), *nearest));
  }
}

JsonNode JsonNode::get(std::string_view key) const {
  const auto node = find(key);
  if (!node) fail(fmt::format("no key \"{}\"", key), "an object that has it");
  return *node;
}

std::optional<JsonNode> JsonNode::find(std::string_view key) const {
  const auto found = value_->find(key);
  if (found == value_->end()) return std::nullopt;
  return JsonNode(*found, *file_, path_of_key(path_, key));
}

std::vector<std::pair<std::string, JsonNode>> JsonNode::members() const {
  if (!value_->is_object()) fail("an object");
  std::vector<std::pair<std::string, JsonNode>> members;
  members.reserve(value_->size());
  for (const auto& [key, value] : value_->items()) {
    members.emplace_back(key, JsonNode(value, *file_, path_of_key(path_, key)));
  }
  return members;
}

std::vector<JsonNode> JsonNode::items() const {
  if (!value_->is_array()) fail("an array");
  std::vector<JsonNode> nodes;
  nodes.reserve(value_->size());
  for (std::size_t i = 0; i < value_->size(); ++i) {
    nodes.emplace_back((*value_)[i], *file_, path_of_item(path_, i));
  }
  return nodes;
}

const std::string& JsonNode::text() const {
  if (!value_->is_string()) fail("a string");
  return value_->get_ref<const std::string&>();
}

bool JsonNode::boolean() const {
  if (!value_->is_boolean()) fail("true or false");
  return value_->get<bool>();
}

double JsonNode::number() const {
  if (!value_->is_number()) fail("a number");
  if (!is_usable(*value_)) fail(fmt::format("a number of magnitude up to {:g}", kLargestNumber));
  return value_->get<double>();
}

double JsonNode::number_above(double bound, const std::string& allowed) const {
  if (!(number() > bound)) fail(allowed);
  return number();
}

double JsonNode::number_at_least(double bound, const std::string& allowed) const {
  if (!(number() >= bound)) fail(allowed);
  return number();
}

std::vector<double> JsonNode::numbers() const {
  if (value_->is_array() && std::ranges::all_of(*value_, is_usable)) {  // no path is needed
    return value_->get<std::vector<double>>();
  }
  std::vector<double> numbers;
  for (const JsonNode& node : items()) numbers.push_back(node.number());
  return numbers;
}

std::vector<double> JsonNode::numbers(int count) const {
  if (value_->is_array() && value_->size() != static_cast<std::size_t>(count)) {
    fail(fmt::format("an array of {} numbers", count));
  }
  return numbers();
}

}  // namespace mbs
