// A JSON value that knows its file and path, so that every complaint about it can name them.
#pragma once

#include <initializer_list>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace mbs {

/// Bound on every number in a scene: products of several of them stay finite.
inline constexpr double kLargestNumber = 1e50;

/// A view; value and file name must outlive it. Everything throws UsageError where the value is not
/// what is asked for: "pendulum.json: rods[0].mass: found "heavy", allowed is a number".
class JsonNode {
 public:
  JsonNode(const nlohmann::json& value, const std::string& file, std::string path = "")
      : value_(&value), file_(&file), path_(std::move(path)) {}

  /// "rods[0].mass"; empty at the top.
  [[nodiscard]] const std::string& path() const { return path_; }

  /// Throws "FILE: PATH: found FOUND, allowed is ALLOWED".
  [[noreturn]] void fail(const std::string& found, const std::string& allowed) const;
  /// The same, with the value itself as what was found.
  [[noreturn]] void fail(const std::string& allowed) const;

  /// Fails with the value, a string, as what was found, and names of `what` as what is allowed:
  /// some of `names` and the one nearest to it.
  [[noreturn]] void fail_name(const std::string& what, const std::vector<std::string>& names) const;

  /// The value must be an object with no other keys than these.
  void allow_keys(std::initializer_list<std::string_view> known) const;
  [[nodiscard]] JsonNode get(std::string_view key) const;  ///< must be there
  [[nodiscard]] std::optional<JsonNode> find(std::string_view key) const;

  [[nodiscard]] bool is_text() const { return value_->is_string(); }
  [[nodiscard]] bool is_object() const { return value_->is_object(); }
  [[nodiscard]] bool is_number() const { return value_->is_number(); }
  /// Members of an object, sorted by key.
  [[nodiscard]] std::vector<std::pair<std::string, JsonNode>> members() const;
  [[nodiscard]] std::vector<JsonNode> items() const;  ///< of an array
  [[nodiscard]] const std::string& text() const;      ///< a string
  [[nodiscard]] bool boolean() const;
  [[nodiscard]] double number() const;  ///< magnitude up to kLargestNumber
  [[nodiscard]] double number_above(double bound, const std::string& allowed) const;
  [[nodiscard]] double number_at_least(double bound, const std::string& allowed) const;
  [[nodiscard]] std::vector<double> numbers() const;           ///< an array of them
  [[nodiscard]] std::vector<double> numbers(int count) const;  ///< of exactly `count`

 private:
  const nlohmann::json* value_;
  const std::string* file_;
  std::string path_;
};

}  // namespace mbs
