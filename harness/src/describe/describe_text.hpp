// How `mbs describe` lays out its text.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace mbs {

/// One line: the label, padded, and what it is.
std::string text_line(const std::string& label, const std::string& text);

/// The names, separated by commas; at most eight.
std::string listed(const nlohmann::json& names);

}  // namespace mbs
