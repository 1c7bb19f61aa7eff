// Keeps what a user has from being written over.
#pragma once

#include <string>

namespace mbs {

/// Whether two paths, of files that may not exist yet, lead to one file: links are followed.
bool is_same_file(const std::string& a, const std::string& b);

/// Throws UsageError if `path`, the value of `option`, is the file of `scene`, or the name of a
/// scene.
void require_not_scene(const std::string& option, const std::string& path,
                       const std::string& scene);

}  // namespace mbs
