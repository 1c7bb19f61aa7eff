// The recommendation as text, printed from the JSON.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <vector>

#include "describe/describe_text.hpp"
#include "describe/features.hpp"
#include "describe/recommendation.hpp"

namespace mbs {
namespace {

using nlohmann::json;

/// The best of a layer; null if it has none.
json best_of(const json& list, const char* layer) {
  const auto found =
      std::ranges::find_if(list, [layer](const json& one) { return one["layer"] == layer; });
  return found == list.end() ? json(nullptr) : *found;
}

std::string variant_text(const json& one) {
  return fmt::format("{}, {} form: {:.3g} us a step ({:.3g} to {:.3g})",
                     one["implementation"].get<std::string>(), one["scheme"].get<std::string>(),
                     one["step_us"].get<double>(), one["low_us"].get<double>(),
                     one["high_us"].get<double>());
}

std::string why_text(const json& d) {
  std::vector<std::string> compared;
  for (const json& one : d["rule"]["candidates"]) {
    const std::string name = one["implementation"];
    compared.push_back(one["refused"].is_null()
                           ? fmt::format("{} {:.3g} us", name, one["step_us"].get<double>())
                           : fmt::format("{}: {}", name, one["refused"].get<std::string>()));
  }
  return fmt::format("the least of those compared: {}; {}", fmt::join(compared, ", "),
                     d["scheme"]["reason"].get<std::string>());
}

std::string certainty_text(const json& rule) {
  const json& held = rule["held"];
  std::string text = fmt::format(
      "{} families ({} scenes) left out in turn: {:.0f} % slower than their fastest in the mean, "
      "{:.0f} % at worst; {:.0f} % of the times right to a factor of 1.5, {:.0f} % inside their "
      "range",
      held["families"].get<int>(), held["scenes"].get<int>(),
      100.0 * held["mean_loss"].get<double>(), 100.0 * held["worst_loss"].get<double>(),
      100.0 * held["within"].get<double>(), 100.0 * held["inside"].get<double>());
  json names = json::array();
  for (const json& name : rule["outside"]) names.push_back(feature_text(name));
  if (!names.empty())
    text += fmt::format("; extrapolated, as this scene is outside of all measured ones in {}",
                        listed(names));
  return text;
}

}  // namespace

std::string recommendation_text(const json& d) {
  const json& list = d["recommendation"];
  if (list.empty()) return text_line("take this", d["no_recommendation"]);
  const json &rule = d["rule"], &nearest = d["nearest"];
  const json library = best_of(list, "library"), own = best_of(list, "own");
  std::string text =
      text_line("take this", library.is_null() ? "no library that was measured serves this"
                                               : fmt::format("{}, predicted from times on {}",
                                                             variant_text(library),
                                                             rule["machine"].get<std::string>()));
  text += text_line("  why", why_text(d));
  text += text_line("  how sure", certainty_text(rule));
  text += text_line(
      "  nearest measured",
      fmt::format("{} (distance {:.2g}): {}, {:.3g} us", nearest["scene"].get<std::string>(),
                  nearest["distance"].get<double>(), nearest["fastest"].get<std::string>(),
                  nearest["step_us"].get<double>()));
  if (!own.is_null()) text += text_line("  own code", variant_text(own));
  return text;
}

}  // namespace mbs
