// The table of pairs, and how the dynamic loader is told to take one of them.
#include "environment/blas.hpp"

#include <dlfcn.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <link.h>

#include <algorithm>
#include <array>
#include <cstring>

#include "environment/build_info.hpp"
#include "usage_error.hpp"

namespace mbs {
namespace {

namespace fs = std::filesystem;

constexpr const char* kBlas = "libblas.so.3";
constexpr std::array kMakers{"openblas", "goto", "atlas", "blis", "flame", "mkl", "armpl"};
constexpr const char* kLapack = "liblapack.so.3";

/// The file behind all links; one that does not exist as it is named.
std::string real_file(const fs::path& file) {
  std::error_code error;
  const fs::path real = fs::canonical(file, error);
  return error ? file.string() : real.string();
}

std::vector<std::string> real_files(const BlasPair& pair) {
  std::vector<std::string> files;
  for (const fs::path& file : {pair.blas_file, pair.lapack_file, pair.preload}) {
    if (!file.empty()) files.push_back(real_file(file));
  }
  return files;
}

bool starts_path_list(const std::string& list, const std::string& prefix) {
  return list == prefix || list.starts_with(prefix + ":");
}

}  // namespace

std::vector<BlasPair> blas_pairs(const fs::path& root) {
  const fs::path reference_lapack = root / "lapack" / kLapack;
  const std::string lapack_package = "liblapack3";
  const std::string openblas = "OpenBLAS (successor of GotoBLAS)";
  const std::string blis = "BLIS (what AMD's AOCL, once ACML, is built on)";
  const auto own = [&](const char* folder) { return root / folder / kBlas; };
  const auto own_lapack = [&](const char* folder) { return root / folder / kLapack; };
  return {
      {"reference", "reference BLAS", "reference LAPACK", "libblas3 " + lapack_package, own("blas"),
       reference_lapack, ""},
      {"atlas-reference", "ATLAS", "reference LAPACK", "libatlas3-base " + lapack_package,
       own("atlas"), reference_lapack, ""},
      {"atlas", "ATLAS", "ATLAS's own LAPACK", "libatlas3-base", own("atlas"), own_lapack("atlas"),
       ""},
      {"openblas-reference", openblas, "reference LAPACK", "libopenblas0-serial " + lapack_package,
       own("openblas-serial"), reference_lapack, ""},
      {"openblas", openblas, "OpenBLAS's own LAPACK", "libopenblas0-serial", own("openblas-serial"),
       own_lapack("openblas-serial"), ""},
      {"blis-reference", blis, "reference LAPACK", "libblis4-serial " + lapack_package,
       own("blis-serial"), reference_lapack, ""},
      {"blis-flame", blis, "libflame (AMD's LAPACK), the rest from the reference",
       "libblis4-serial libflame1 " + lapack_package, own("blis-serial"), reference_lapack,
       root / "libflame.so.1"},
  };
}

const std::vector<BlasPair>& blas_pairs() {
  static const std::vector<BlasPair> pairs = blas_pairs(build_info().library_folder);
  return pairs;
}

std::string why_unavailable(const BlasPair& pair) {
  std::vector<std::string> missing;
  for (const fs::path& file : {pair.blas_file, pair.lapack_file, pair.preload}) {
    std::error_code error;
    if (!file.empty() && !fs::exists(file, error)) missing.push_back(file.string());
  }
  if (missing.empty()) return "";
  return fmt::format("{} missing: apt-get install {}", fmt::join(missing, ", "), pair.package);
}

std::optional<std::string> asked_blas(int argc, const char* const* argv) {
  std::optional<std::string> asked;
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "--blas") == 0 && i + 1 < argc) asked = argv[i + 1];
    if (std::strncmp(argv[i], "--blas=", 7) == 0) asked = argv[i] + 7;
  }
  return asked;
}

const BlasPair& available_pair(const std::string& name) {
  const auto& pairs = blas_pairs();
  const auto found = std::ranges::find(pairs, name, &BlasPair::name);
  if (found == pairs.end()) {
    std::vector<std::string> known;
    for (const BlasPair& pair : pairs) known.push_back(pair.name);
    throw UsageError(fmt::format("--blas is '{}': there are {}", name, fmt::join(known, ", ")));
  }
  const std::string reason = why_unavailable(*found);
  if (!reason.empty()) {
    throw UsageError(fmt::format("--blas {}: cannot be selected: {}", name, reason));
  }
  return *found;
}

std::vector<std::pair<std::string, std::string>> loader_environment(const BlasPair& pair,
                                                                    const std::string& library_path,
                                                                    const std::string& preload) {
  // The folder of the LAPACK first: those of a BLAS may hold a LAPACK too, never the reverse.
  const std::string lapack = pair.lapack_file.parent_path(), blas = pair.blas_file.parent_path();
  const std::string folders = lapack == blas ? blas : lapack + ":" + blas;
  std::vector<std::pair<std::string, std::string>> changes;
  const auto prepend = [&](const char* name, const std::string& front, const std::string& present) {
    if (front.empty() || starts_path_list(present, front)) return;
    changes.emplace_back(name, present.empty() ? front : front + ":" + present);
  };
  prepend("LD_LIBRARY_PATH", folders, library_path);
  prepend("LD_PRELOAD", pair.preload, preload);
  return changes;
}

std::string why_not_in_effect(const BlasPair& pair, const std::vector<BlasPair>& all,
                              const std::vector<std::string>& mapped) {
  const auto is_mapped = [&](const std::string& file) {
    return std::ranges::find(mapped, file) != mapped.end();
  };
  const std::vector<std::string> mine = real_files(pair);
  for (const std::string& file : mine) {
    if (!is_mapped(file)) return file + " is not loaded";
  }
  for (const BlasPair& other : all) {
    for (const std::string& file : real_files(other)) {
      if (is_mapped(file) && std::ranges::find(mine, file) == mine.end()) {
        return file + " is loaded too";
      }
    }
  }
  return why_foreign(mine, mapped);
}

std::vector<std::string> generic_blas_files() {
  std::vector<std::string> files;
  for (const char* name : {kBlas, kLapack}) {
    void* library = dlopen(name, RTLD_LAZY | RTLD_NOLOAD);
    const link_map* map = nullptr;
    if (library == nullptr) continue;
    if (dlinfo(library, RTLD_DI_LINKMAP, &map) == 0) files.push_back(real_file(map->l_name));
    dlclose(library);
  }
  return files;
}

std::string why_foreign(const std::vector<std::string>& own,
                        const std::vector<std::string>& mapped) {
  for (const std::string& file : mapped) {
    const fs::path folder = fs::path(file).parent_path();
    const auto is_foreign = [&](const char* maker) {
      const auto is_of = [&](const std::string& one) {
        const fs::path place = fs::path(one).parent_path();
        return one.find(maker) != std::string::npos &&
               (folder == place || folder == place.parent_path());
      };
      return file.find(maker) != std::string::npos && std::ranges::none_of(own, is_of);
    };
    if (std::ranges::any_of(kMakers, is_foreign)) {
      return file + " is loaded too (an implementation links it by its own name?)";
    }
  }
  return "";
}

}  // namespace mbs
