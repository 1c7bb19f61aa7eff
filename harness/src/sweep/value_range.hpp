// The values that a user's range stands for.
#pragma once

#include <string>
#include <vector>

namespace mbs {

inline constexpr long kMostLanes = 1'000'000;  ///< of a sweep

/// Throws UsageError: what --vary has for `path`, and what it may have.
[[noreturn]] void refuse_vary(const std::string& path, const std::string& found,
                              const std::string& allowed);

double parse_number(const std::string& text, const std::string& path);

/// "a:b:K" is K values evenly spaced from a to b, both included; "a:b:K:log" the same with even
/// ratios; "v1,v2,..." a list. `path` is for errors. Throws UsageError.
std::vector<double> parse_range(const std::string& text, const std::string& path);

}  // namespace mbs
