// Sets one thread and the asked BLAS by executing the program again with the right environment.
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

/// Names the process that has already executed itself again. It holds the process id, which exec
/// keeps, so that a value inherited from elsewhere cannot switch the guarantee off.
constexpr const char* kGuard = "MBS_EXECUTED_AGAIN";

std::string variable(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

bool executed_again() { return variable(kGuard) == std::to_string(getpid()); }

/// What the loader and the libraries must find in the environment and do not.
std::vector<std::pair<std::string, std::string>> missing_variables(const BlasPair* pair) {
  std::vector<std::pair<std::string, std::string>> missing;
  for (const std::string& name : thread_variables()) {
    if (variable(name.c_str()) != "1") missing.emplace_back(name, "1");
  }
  if (pair == nullptr) return missing;
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
        pair ? why_not_in_effect(*pair, blas_pairs(), loaded_blas_files()) : "";
    if (wrong.empty()) return;
    throw UsageError(fmt::format("--blas {}: did not take effect: {}", *asked, wrong));
  }
  const std::string& first = missing.front().first;
  if (executed_again()) {
    throw UsageError(fmt::format("the environment of this system does not keep {}={}", first,
                                 missing.front().second));
  }
  setenv(kGuard, std::to_string(getpid()).c_str(), 1);
  for (const auto& [name, value] : missing) setenv(name.c_str(), value.c_str(), 1);
  const std::string program = own_path();
  execv(program.c_str(), argv);
  throw UsageError(fmt::format("the program cannot execute itself again as {} ({}): set {} by hand",
                               program, std::strerror(errno), first));
}

}  // namespace mbs
