// What the tests of scenes share: shipped files, errors as text, a pendulum to spoil.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "scene_file/load_scene.hpp"
#include "usage_error.hpp"

namespace mbs {

inline const std::filesystem::path kScenes = std::filesystem::path(MBS_ROOT) / "harness/scenes";

/// The message of load_scene's UsageError.
inline std::string error_of(const std::string& text) {
  try {
    load_scene(text);
  } catch (const UsageError& error) {
    return error.what();
  }
  return "no error";
}

/// The message of parse_scene's UsageError, or "no error".
inline std::string parse_error_of(std::string_view json) {
  try {
    parse_scene(json, "test.json");
  } catch (const UsageError& error) {
    return error.what();
  }
  return "no error";
}

/// A short line with all of these in it.
inline void expect_parts(const std::string& message, const std::vector<std::string>& parts) {
  for (const std::string& part : parts) {
    EXPECT_NE(message.find(part), std::string::npos) << '"' << part << "\" is not in: " << message;
  }
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  EXPECT_LT(message.size(), 700u) << message;
}

/// The pendulum with the text `from` replaced.
inline std::string pendulum(const std::string& from = "", const std::string& to = "") {
  std::string text = R"({"points": [{"name": "A", "position": [0, 0], "fixed": true},
    {"name": "B", "position": [0, -2], "velocity": [1, 0]}],
    "rods": [{"name": "rod", "between": ["A", "B"], "mass": 3}]})";
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

}  // namespace mbs
