// Reads KEY=VALUE words; what is wrong is said in one line.
#include <algorithm>

#include "engine.hpp"

namespace engines {

Settings::Settings(const std::vector<std::string>& words) {
  for (const std::string& word : words) {
    const auto equals = word.find('=');
    if (equals == std::string::npos || equals == 0)
      throw UsageError("--setting " + word + ": it must be KEY=VALUE");
    const std::string key = word.substr(0, equals);
    if (!values_.emplace(key, word.substr(equals + 1)).second)
      throw UsageError("--setting " + key + " is given twice");
  }
}

double Settings::number(const std::string& key, double usual) {
  taken_[key] = true;
  const auto found = values_.find(key);
  if (found == values_.end()) return usual;
  std::size_t used = 0;
  double value = -1.0;
  try {
    value = std::stod(found->second, &used);
  } catch (const std::logic_error&) {
    used = 0;
  }
  if (used == 0 || used != found->second.size() || !std::isfinite(value) || value < 0.0)
    throw UsageError("--setting " + key + "=" + found->second +
                     ": it must be a number of at least 0");
  return value;
}

double Settings::positive(const std::string& key, double usual) {
  const double value = number(key, usual);
  if (!(value > 0.0)) throw UsageError("--setting " + key + ": it must be above 0");
  return value;
}

std::size_t Settings::choice(const std::string& key, const std::vector<std::string>& choices) {
  taken_[key] = true;
  const auto found = values_.find(key);
  if (found == values_.end()) return 0;
  const auto place = std::ranges::find(choices, found->second);
  if (place != choices.end()) return static_cast<std::size_t>(place - choices.begin());
  std::string known;
  for (const std::string& one : choices) known += (known.empty() ? "" : ", ") + one;
  throw UsageError("--setting " + key + "=" + found->second + ": known are " + known);
}

void Settings::require_all_taken() const {
  for (const auto& [key, value] : values_) {
    if (!taken_.contains(key)) {
      std::string known;
      for (const auto& [name, unused] : taken_) known += (known.empty() ? "" : ", ") + name;
      throw UsageError("--setting " + key +
                       " means nothing here; known with these settings: " + known);
    }
  }
}

}  // namespace engines
