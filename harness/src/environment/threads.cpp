// Forces one thread by executing the program again with the right environment.
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>

#include "environment/environment.hpp"
#include "usage_error.hpp"

namespace mbs {
namespace {

/// Names the process that has already executed itself again. It holds the process id, which exec
/// keeps, so that a value inherited from elsewhere cannot switch the guarantee off.
constexpr const char* kGuard = "MBS_EXECUTED_AGAIN";

bool is_single(const std::string& name) {
  const char* value = std::getenv(name.c_str());
  return value != nullptr && std::strcmp(value, "1") == 0;
}

}  // namespace

const std::vector<std::string>& thread_variables() {
  static const std::vector<std::string> names{"OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS",
                                              "GOTO_NUM_THREADS", "BLIS_NUM_THREADS",
                                              "MKL_NUM_THREADS"};
  return names;
}

void single_thread_environment(char** argv) {
  bool single = true;
  for (const std::string& name : thread_variables()) single = single && is_single(name);
  if (single) return;

  const std::string process = std::to_string(getpid());
  const char* guard = std::getenv(kGuard);
  if (guard != nullptr && process == guard) {
    throw UsageError("the environment of this system does not keep OMP_NUM_THREADS=1 and the like");
  }
  setenv(kGuard, process.c_str(), 1);
  for (const std::string& name : thread_variables()) setenv(name.c_str(), "1", 1);
  execv("/proc/self/exe", argv);
  throw UsageError(
      fmt::format("the program cannot execute itself again through /proc/self/exe ({}): "
                  "set {}=1 and the like by hand",
                  std::strerror(errno), thread_variables().front()));
}

}  // namespace mbs
