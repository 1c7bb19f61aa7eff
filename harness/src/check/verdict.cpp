// JSON form of verdicts; absent numbers are null.
#include "check/verdict.hpp"

#include <cmath>

namespace mbs {
namespace {

template <typename T>
nlohmann::json nullable(const std::optional<T>& value) {
  if (!value) return nullptr;
  if constexpr (std::is_same_v<T, double>) {
    if (!std::isfinite(*value)) return nullptr;
  }
  return *value;
}

template <typename T>
std::optional<T> optional_of(const nlohmann::json& json) {
  if (json.is_null()) return std::nullopt;
  return json.get<T>();
}

}  // namespace

void to_json(nlohmann::json& json, const Check& check) {
  json = {{"name", check.name},
          {"value", nullable(check.value)},
          {"tolerance", nullable(check.tolerance)},
          {"passed", nullable(check.passed)},
          {"detail", check.detail}};
}

void from_json(const nlohmann::json& json, Check& check) {
  check.name = json.at("name").get<std::string>();
  check.value = optional_of<double>(json.at("value"));
  check.tolerance = optional_of<double>(json.at("tolerance"));
  check.passed = optional_of<bool>(json.at("passed"));
  check.detail = json.at("detail").get<std::string>();
}

void to_json(nlohmann::json& json, const Verdict& verdict) {
  json = {{"scene", verdict.scene},
          {"implementation", verdict.implementation},
          {"verdict", verdict.verdict},
          {"reason", verdict.reason},
          {"checks", verdict.checks}};
}

void from_json(const nlohmann::json& json, Verdict& verdict) {
  verdict.scene = json.at("scene").get<std::string>();
  verdict.implementation = json.at("implementation").get<std::string>();
  verdict.verdict = json.at("verdict").get<std::string>();
  verdict.reason = json.at("reason").get<std::string>();
  verdict.checks = json.at("checks").get<std::vector<Check>>();
}

}  // namespace mbs
