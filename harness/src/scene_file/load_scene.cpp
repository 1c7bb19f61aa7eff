// From what the user typed to a Scene.
#include "scene_file/load_scene.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "printable.hpp"
#include "scene/families/families.hpp"
#include "scene_file/json_text.hpp"
#include "usage_error.hpp"

namespace mbs {
namespace {

constexpr std::string_view kFourBar = "four-bar:";
// About 400 000 rods. The worst JSON of this size takes 1 GB to parse.
constexpr std::size_t kLargestFile = std::size_t{32} << 20;  // bytes
constexpr std::size_t kLongestName = 4096;                   // bytes; no path is longer

[[noreturn]] void fail(const std::string& scene, const std::string& what) {
  throw UsageError(fmt::format("scene {}: {}", in_quotes(scene), what));
}

int parse_loops(const std::string& scene, std::string_view text) {
  return parse_whole(scene, text, "N", 1, kMostLoops);
}

/// The text behind "NAME=" in an option.
std::string_view value_of(const std::string& scene, std::string_view name,
                          std::string_view option) {
  const auto equals = option.find('=');
  if (option.substr(0, equals) != name || equals == std::string_view::npos) {
    fail(scene, fmt::format("found the option {}, allowed is fill=F or fill=F,seed=S",
                            in_quotes(option)));
  }
  return option.substr(equals + 1);
}

double parse_fill(const std::string& scene, std::string_view option) {
  const std::string_view text = value_of(scene, "fill", option);
  double fill = 0.0;
  const auto [end, error] =
      std::from_chars(text.data(), text.data() + text.size(), fill, std::chars_format::fixed);
  const bool decimal = text.find_first_not_of("0123456789.") == std::string_view::npos;
  if (!decimal || error != std::errc{} || end != text.data() + text.size() ||
      !(fill > 0.0 && fill <= 1.0)) {
    fail(scene, fmt::format("found {} for F, allowed is a decimal number above 0, up to 1",
                            in_quotes(text)));
  }
  return fill;
}

Scene load_four_bar(const std::string& scene) {
  const std::string_view rest = std::string_view(scene).substr(kFourBar.size());
  const auto comma = rest.find(',');
  const int loops = parse_loops(scene, rest.substr(0, comma));
  if (comma == std::string_view::npos) {
    return {scene, Model(four_bar(loops)), loops, {}, four_bar_elements(loops), {}};
  }
  const std::string_view options = rest.substr(comma + 1);
  const auto second = options.find(',');
  const double asked = parse_fill(scene, options.substr(0, second));
  const std::uint64_t seed =
      second == std::string_view::npos
          ? kFillSeed
          : static_cast<std::uint64_t>(
                parse_whole(scene, value_of(scene, "seed", options.substr(second + 1)), "S", 1,
                            std::numeric_limits<int>::max()));
  ModelData data = four_bar(loops);
  try {
    const Fill fill = add_fill(data, asked, seed);
    return {scene, Model(std::move(data)), loops, fill, four_bar_elements(loops), {}};
  } catch (const UsageError& error) {
    fail(scene, error.what());
  }
}

[[noreturn]] void fail_too_large(const std::string& path) {
  fail(path, fmt::format("the file is too large, allowed are {} bytes", kLargestFile));
}

std::string read_file(const std::string& path) {
  std::error_code error;
  const auto size = std::filesystem::file_size(path, error);  // of a regular file
  if (!error && size > kLargestFile) fail_too_large(path);
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  std::string text;
  std::string chunk(std::size_t{1} << 16, '\0');
  while (file) {
    file.read(chunk.data(), static_cast<std::streamsize>(chunk.size()));
    text.append(chunk, 0, static_cast<std::size_t>(file.gcount()));
    if (text.size() > kLargestFile) {
      fail_too_large(path);
    }
  }
  if (!file.eof()) {
    fail(path, fmt::format("the file cannot be read: {}",
                           errno != 0 ? std::strerror(errno) : "unknown reason"));
  }
  return text;
}

/// Throws unless there may be a JSON scene at `path`.
void require_file(const std::string& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) {
    std::vector<std::string> forms;
    for (const SceneFamily& family : scene_families()) forms.push_back(family.form());
    const bool missing = status.type() == std::filesystem::file_type::not_found || path.empty();
    fail(path,
         fmt::format("{}; allowed are four-bar:N (N from 1 to {}), four-bar:N,fill=F (F above "
                     "0, up to 1; and ,seed=S for other positions), {} (mbs list --scenes), or the path of a JSON scene file",
                     missing ? "no such file and no such kind of scene" : error.message(),
                     kMostLoops, fmt::join(forms, ", ")));
  }
  if (std::filesystem::is_directory(status)) {
    fail(path, "this is a directory, allowed is a JSON scene file");
  }
}

}  // namespace

Scene load_scene(const std::string& text) {
  return text.starts_with(kFourBar) ? load_four_bar(text) : scene_of(load_document(text), text);
}

nlohmann::json load_document(const std::string& text) {
  if (is_family_scene(text)) return family_document(text);
  if (!text.starts_with(kFourBar)) {
    require_file(text);
    return parse_json(read_file(text), text);
  }
  if (text.find(',') != std::string::npos) {
    fail(text,
         "artificial fill is in no document, allowed are four-bar:N, scenes of a family (mbs list "
         "--scenes) and JSON scene files");
  }
  return four_bar_document(parse_loops(text, std::string_view(text).substr(kFourBar.size())));
}

Scene scene_of(const nlohmann::json& document, const std::string& name, Unused unused) {
  // Paths may hold any bytes; a scene's name ends up in JSON and must be UTF-8.
  SceneData data = read_scene(document, name, unused);
  return {printable(name, kLongestName), Model(std::move(data.model)), {}, {},
          std::move(data.elements),      std::move(data.assembly)};
}

}  // namespace mbs
