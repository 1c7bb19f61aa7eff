// Sets one thread and the asked BLAS by executing the program again with the right environment.
#include <dlfcn.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <utility>

#include "environment/blas.hpp"
#include "environment/environment.hpp"
#include "usage_error.hpp"

namespace mbs {
namespace {

/// What the process has already executed itself again for: its id, which exec keeps, so that a
/// value inherited from elsewhere cannot switch the guarantee off, and names of variables.
constexpr const char* kGuard = "MBS_EXECUTED_AGAIN";
constexpr const char* kOpenBlasKernels = "OPENBLAS_CORETYPE";

std::string variable(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

/// The guard's value, "<process id> NAME NAME ... "; without names before the first time.
std::string executed_for() {
  const std::string own = std::to_string(getpid()) + " ", found = variable(kGuard);
  return found.starts_with(own) ? found : own;
}

/// What OpenBLAS has to be told where it does not know the processor and falls back to its oldest
/// kernels, which take up to twice the time (0.3.21 on processors from 2023 on); empty if it does,
/// was told already, or is not there.
std::string kernels_for_openblas() {
#if defined(__x86_64__)
  if (!variable(kOpenBlasKernels).empty()) return "";
  const auto name =
      reinterpret_cast<const char* (*)()>(dlsym(RTLD_DEFAULT, "openblas_get_corename"));
  if (name == nullptr || std::string(name()) != "Prescott") return "";
  if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("fma")) return "";
  const bool wide = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
                    __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl");
  return wide ? "SkylakeX" : "Haswell";
#else
  return "";
#endif
}

/// What the loader and the libraries must find in the environment and do not.
std::vector<std::pair<std::string, std::string>> missing_variables(const BlasPair* pair) {
  std::vector<std::pair<std::string, std::string>> missing;
  for (const std::string& name : thread_variables()) {
    if (variable(name.c_str()) != "1") missing.emplace_back(name, "1");
  }
  const std::string kernels = kernels_for_openblas();
  if (!kernels.empty()) missing.emplace_back(kOpenBlasKernels, kernels);
  if (pair == nullptr || why_not_in_effect(*pair, blas_pairs(), loaded_blas_files()).empty()) {
    return missing;  // the pair may be what the system takes anyway
  }
  for (auto& change :
       loader_environment(*pair, variable("LD_LIBRARY_PATH"), variable("LD_PRELOAD"))) {
    missing.push_back(std::move(change));
  }
  return missing;
}

/// This program's file. Not the link itself where that can be: under Valgrind it leads to Valgrind.
std::string own_path() {
  const std::filesystem::path link = "/proc/self/exe";
  std::error_code error;
  const auto path = std::filesystem::read_symlink(link, error);
  return (!error && std::filesystem::exists(path) ? path : link).string();
}

}  // namespace

const std::vector<std::string>& thread_variables() {
  static const std::vector<std::string> names{"OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS",
                                              "GOTO_NUM_THREADS", "BLIS_NUM_THREADS",
                                              "MKL_NUM_THREADS"};
  return names;
}

void settle_environment(int argc, char** argv) {
  const auto asked = asked_blas(argc, argv);
  const BlasPair* pair = asked ? &available_pair(*asked) : nullptr;
  const auto missing = missing_variables(pair);
  if (missing.empty()) {
    const std::string wrong =
        pair ? why_not_in_effect(*pair, blas_pairs(), loaded_blas_files())
             : why_foreign(generic_blas_files(), loaded_blas_files());
    if (wrong.empty()) return;
    throw UsageError(pair ? fmt::format("--blas {}: did not take effect: {}", *asked, wrong)
                          : "the system's BLAS and LAPACK are not the only ones: " + wrong);
  }
  const std::string& first = missing.front().first;
  std::string tried = executed_for();
  if (tried.find(" " + first + " ") != std::string::npos) {
    throw UsageError(fmt::format("the environment of this system does not keep {}={}", first,
                                 missing.front().second));
  }
  for (const auto& [name, value] : missing) {
    setenv(name.c_str(), value.c_str(), 1);
    tried += name + " ";
  }
  setenv(kGuard, tried.c_str(), 1);
  const std::string program = own_path();
  execv(program.c_str(), argv);
  throw UsageError(fmt::format("the program cannot execute itself again as {} ({}): set {} by hand",
                               program, std::strerror(errno), first));
}

}  // namespace mbs
