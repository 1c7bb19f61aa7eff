// Splits at colons or commas.
#include "sweep/value_range.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <string_view>

#include "printable.hpp"
#include "usage_error.hpp"

namespace mbs {
namespace {

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts{""};
  for (const char c : text) {
    if (c == separator) {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  return parts;
}

template <class Number>
bool parse_all(std::string_view text, Number& value) {
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  return error == std::errc{} && stop == end;
}

long parse_count(const std::string& text, const std::string& path) {
  long count = 0;
  if (!parse_all(text, count) || count < 2 || count > kMostLanes) {
    refuse_vary(path, fmt::format("{} for the number of values", in_quotes(text)),
                fmt::format("2 to {}", kMostLanes));
  }
  return count;
}

}  // namespace

void refuse_vary(const std::string& path, const std::string& found, const std::string& allowed) {
  throw UsageError(
      fmt::format("--vary {}: found {}, allowed is {}", in_quotes(path), found, allowed));
}

double parse_number(const std::string& text, const std::string& path) {
  double value = 0.0;
  if (!parse_all(text, value) || !std::isfinite(value)) {
    refuse_vary(
        path, in_quotes(text),
        "a number, in a range a:b:K (K values from a to b), a:b:K:log, or a list v1,v2,...");
  }
  return value;
}

std::vector<double> parse_range(const std::string& text, const std::string& path) {
  std::vector<double> values;
  if (text.find(':') == std::string::npos) {
    for (const std::string& part : split(text, ',')) values.push_back(parse_number(part, path));
    return values;
  }
  const std::vector<std::string> parts = split(text, ':');
  const bool is_log = parts.size() == 4 && parts[3] == "log";
  if (parts.size() != 3 && !is_log)
    refuse_vary(path, in_quotes(text), "a:b:K, a:b:K:log or v1,v2,...");
  const double first = parse_number(parts[0], path), last = parse_number(parts[1], path);
  const long count = parse_count(parts[2], path);
  if (is_log && (first == 0.0 || last == 0.0 || (first > 0.0) != (last > 0.0))) {
    refuse_vary(path, in_quotes(text), "ends of one sign, and not 0, for even ratios");
  }
  for (long i = 0; i < count; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(count - 1);
    // Neither product nor ratio of the ends need be a number.
    values.push_back(is_log ? std::copysign(std::pow(std::abs(first), 1 - share) *
                                                std::pow(std::abs(last), share),
                                            first)
                            : std::lerp(first, last, share));
  }
  values.back() = last;  // pow() may be off by a rounding
  return values;
}

}  // namespace mbs
