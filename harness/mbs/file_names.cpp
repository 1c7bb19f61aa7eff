// Compares files where they exist, names where they do not.
#include "mbs/file_names.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "printable.hpp"
#include "scene/families/families.hpp"
#include "usage_error.hpp"

namespace mbs {

namespace fs = std::filesystem;

bool is_same_file(const std::string& a, const std::string& b) {
  std::error_code error;
  if (fs::equivalent(a, b, error)) return true;
  // Absolute first: a relative name of which no part exists would stay relative.
  const auto name = [&error](const std::string& path) {
    return fs::weakly_canonical(fs::absolute(path, error), error);
  };
  const fs::path first = name(a);
  return !first.empty() && first == name(b);  // empty: where no file can be
}

void require_not_scene(const std::string& option, const std::string& path,
                       const std::string& scene) {
  const bool is_table = path.ends_with(".csv") || path.ends_with(".json") || path.ends_with(".gz");
  if (!is_table && (path.starts_with("four-bar:") || is_family_scene(path))) {
    throw UsageError(fmt::format("{}: found {}, the name of a scene, allowed is a file", option,
                                 in_quotes(path)));
  }
  std::error_code error;
  if (path.empty() || !fs::exists(scene, error) || !is_same_file(path, scene)) return;
  throw UsageError(fmt::format("{}: found {}, the scene's own file, allowed is another", option,
                               in_quotes(path)));
}

}  // namespace mbs
