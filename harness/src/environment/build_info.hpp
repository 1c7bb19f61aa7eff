// What this program was built from; refreshed at every build by harness/cmake/build_info.cmake.
#pragma once

namespace mbs {

struct BuildInfo {
  const char* version;     ///< of the project, "0.1.0"
  const char* commit;      ///< 40 hexadecimal digits, or "unknown" outside a repository
  const char* dirty;       ///< "true" if a file other than results differed, "false", or "unknown"
  const char* compiler;    ///< "GNU 12.2.0"
  const char* flags;       ///< of a C++ compilation
  const char* build_type;  ///< "Release"
  const char* library_folder;  ///< where Debian has its libraries, "/usr/lib/x86_64-linux-gnu"
};

const BuildInfo& build_info();

}  // namespace mbs
