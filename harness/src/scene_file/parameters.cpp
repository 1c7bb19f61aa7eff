// Parameters become constants of one parser when an expression first needs them.
#include "scene_file/parameters.hpp"

#include <fmt/format.h>
#include <muParser.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <numbers>
#include <set>
#include <string_view>
#include <vector>

#include "printable.hpp"
#include "scene_file/json_node.hpp"
#include "scene_file/json_text.hpp"

namespace mbs {
namespace {

using nlohmann::json;

constexpr std::size_t kMostParameters = 1000;
constexpr std::size_t kLongestExpression = 1000;  // bytes
constexpr const char* kParameters = "parameters";

/// Where a value is; its path is needed for messages only.
struct Place {
  const Place* above = nullptr;
  std::string_view key = {};  // of an object's member
  std::size_t index = 0;      // of an array's item

  [[nodiscard]] std::string path() const {
    if (above == nullptr) return "";
    const std::string before = above->path();
    return key.data() != nullptr ? path_of_key(before, key) : path_of_item(before, index);
  }
};

bool is_parameter_name(std::string_view name) {
  const auto is_letter = [](char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0 || c == '_'; };
  const auto is_any = [&](char c) { return is_letter(c) || (c >= '0' && c <= '9'); };
  return !name.empty() && is_letter(name.front()) && std::ranges::all_of(name, is_any);
}

class Evaluator {
 public:
  Evaluator(const json& document, const std::string& where) : where_(where) {
    parser_.ClearConst();
    parser_.DefineConst("pi", std::numbers::pi);
    const auto found = document.find(kParameters);
    if (found == document.end()) return;
    parameters_ = &*found;
    const JsonNode node(*parameters_, where_, kParameters);
    if (parameters_->size() > kMostParameters && parameters_->is_object()) {
      node.fail(fmt::format("{} of them", parameters_->size()), fmt::format("{}", kMostParameters));
    }
    for (const auto& [name, value] : node.members()) {
      if (!is_parameter_name(name) || name == "pi" || parser_.GetFunDef().contains(name)) {
        value.fail("the name " + in_quotes(name),
                   "letters, digits and underscores, no digit in front, and neither pi nor a function");
      }
      if (!value.is_number() && !is_expression((*parameters_)[name])) {
        value.fail("a number or an expression that begins with \"=\"");
      }
    }
  }

  json resolved(const json& value, const Place& place) {
    if (is_expression(value)) return number(value, place.path());
    if (!value.is_structured()) return value;
    json result = value.is_object() ? json::object() : json::array();
    std::size_t index = 0;
    for (const auto& [key, member] : value.items()) {
      if (value.is_array()) {
        result.push_back(resolved(member, {&place, {}, index++}));
      } else if (place.above != nullptr || key != kParameters) {
        result[key] = resolved(member, {&place, key});
      }
    }
    return result;
  }

  /// What expressions of `value` name, and theirs; whatever the numbers are.
  void use(const json& value) {
    if (is_expression(value)) {
      for (const std::string& name : names_in(value.get_ref<const std::string&>().substr(1))) {
        const bool is_known = parameters_ != nullptr && parameters_->contains(name);
        if (is_known && used_.insert(name).second) use((*parameters_)[name]);
      }
    } else if (value.is_structured()) {
      for (const json& member : value) use(member);
    }
  }

  [[nodiscard]] std::vector<std::string> unused_names() const {
    std::vector<std::string> names;
    if (parameters_ == nullptr) return names;
    for (const auto& [name, value] : parameters_->items()) {
      if (!used_.contains(name)) names.push_back(name);
    }
    return names;
  }

  void require_all_used() const {
    for (const std::string& name : unused_names()) {
      JsonNode((*parameters_)[name], where_, path_of_key(kParameters, name))
          .fail("a parameter that nothing uses", "one that an expression names");
    }
  }

 private:
  /// Those that are no constants yet.
  std::vector<std::string> names_in(const std::string& expression) {
    parser_.SetExpr(expression);
    std::vector<std::string> names;  // the parser may be used for these before it is for the whole
    for (const auto& [name, unused] : parser_.GetUsedVar()) names.push_back(name);
    return names;
  }

  /// Of an expression, or of a parameter that is a number.
  double number(const json& value, const std::string& path) {
    const JsonNode node(value, where_, path);
    if (value.is_number()) return node.number();
    const std::string text = node.text().substr(1);
    if (text.size() > kLongestExpression) {
      node.fail(fmt::format("an expression of {} bytes", text.size()),
                fmt::format("up to {}", kLongestExpression));
    }
    const std::string found = in_quotes(node.text());
    try {
      for (const std::string& name : names_in(text)) define(name, node);
      parser_.SetExpr(text);
      const double result = parser_.Eval();
      if (parser_.GetNumResults() != 1) node.fail(found, "one expression");
      if (!(std::abs(result) <= kLargestNumber)) {
        node.fail(fmt::format("{}, which is {}", found, result),
                  fmt::format("a finite number of magnitude up to {:g}", kLargestNumber));
      }
      return result;
    } catch (const mu::Parser::exception_type& error) {
      node.fail(fmt::format("{} ({})", found, printable(error.GetMsg(), 120)),
                "an expression of numbers, parameters, pi, functions and operators");
    }
  }

  /// Makes the parameter a constant of the parser; `user` is the expression that names it.
  void define(const std::string& name, const JsonNode& user) {
    if (parameters_ == nullptr || !parameters_->contains(name)) {
      std::string known = "pi";
      if (parameters_ != nullptr) {
        for (const auto& [key, value] : parameters_->items()) {
          if (known.size() < 150) known += ", " + printable(key);
        }
      }
      user.fail(fmt::format("the unknown name {} in {}", in_quotes(name), in_quotes(user.text())),
                "one of " + known);
    }
    used_.insert(name);
    if (!pending_.insert(name).second) {
      user.fail(fmt::format("{} in {}, which depends on itself", in_quotes(name), in_quotes(user.text())),
                "parameters that end at numbers");
    }
    const double value = number((*parameters_)[name], path_of_key(kParameters, name));
    pending_.erase(name);
    parser_.DefineConst(name, value);
  }

  const std::string& where_;
  const json* parameters_ = nullptr;
  mu::Parser parser_;
  std::set<std::string> used_, pending_;
};

bool has_expression(const json& value) {
  if (is_expression(value)) return true;
  if (!value.is_structured()) return false;
  return std::ranges::any_of(value, has_expression);
}

}  // namespace

bool is_expression(const json& value) {
  return value.is_string() && value.get_ref<const std::string&>().starts_with('=');
}

std::optional<json> with_numbers(const json& document, const std::string& where, Unused unused) {
  if (!document.is_object()) return std::nullopt;
  if (!document.contains(kParameters) && !has_expression(document)) return std::nullopt;
  Evaluator evaluator(document, where);
  json result = evaluator.resolved(document, {});
  if (unused == Unused::refused) evaluator.require_all_used();
  return result;
}

std::vector<std::string> unused_parameters(const json& document, const std::string& where) {
  Evaluator evaluator(document, where);
  for (const auto& [key, value] : document.items()) {
    if (key != kParameters) evaluator.use(value);
  }
  return evaluator.unused_names();
}

}  // namespace mbs
