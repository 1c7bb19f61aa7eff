// The program `mbs`: list, describe, simulate, sweep, check, reference, limit, bench.
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <exception>
#include <new>
#include <string>

#include "environment/environment.hpp"
#include "environment/kept_memory.hpp"
#include "mbs/run_program.hpp"
#include "printable.hpp"

namespace {

/// Lets an allocation beyond the machine's memory fail, instead of waking the kernel's killer.
void limit_memory() {
#if !defined(__SANITIZE_ADDRESS__)  // which reserves terabytes of address space
  const auto bytes = static_cast<rlim_t>(::sysconf(_SC_PHYS_PAGES)) *
                     static_cast<rlim_t>(::sysconf(_SC_PAGE_SIZE));
  rlimit limit{};
  ::getrlimit(RLIMIT_AS, &limit);
  limit.rlim_cur = std::min(limit.rlim_cur, bytes);
  ::setrlimit(RLIMIT_AS, &limit);
#endif
}

/// As many files as are allowed: each job of a sweep has a handle, and its parts are merged together.
void raise_files() {
  rlimit limit{};
  ::getrlimit(RLIMIT_NOFILE, &limit);
  limit.rlim_cur = limit.rlim_max;
  ::setrlimit(RLIMIT_NOFILE, &limit);
}

/// Libraries put scratch memory of megabytes on the stack: without it they would crash.
bool has_stack() {
  constexpr rlim_t kNeeded = 8u << 20;  // what Linux gives by default
  rlimit limit{};
  ::getrlimit(RLIMIT_STACK, &limit);
  if (limit.rlim_cur >= kNeeded) return true;
  limit.rlim_cur = kNeeded;
  limit.rlim_max = std::max(limit.rlim_max, kNeeded);
  return ::setrlimit(RLIMIT_STACK, &limit) == 0;  // in force at once: the stack grows when touched
}

/// The status to leave with: what was printed must have arrived.
int finish(int status) {
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return status;
  std::fputs("mbs: cannot write to standard output\n", stderr);
  return status == 0 ? 2 : status;
}

/// One line, and never an exception: standard error may be closed.
int fail(const std::string& message) {
  std::fputs(("mbs: " + message + "\n").c_str(), stderr);
  return 2;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    if (!has_stack()) return fail("the stack's limit is below 8 MiB (ulimit -Hs), which mbs needs");
    limit_memory();
    raise_files();
    mbs::keep_memory();
    std::signal(SIGXFSZ, SIG_IGN);  // a file over the limit is an error like any other full disk
    mbs::settle_environment(argc, argv);
    return finish(mbs::run_program(argc, argv));
  } catch (const std::bad_alloc&) {
    return fail("not enough memory for this scene with this implementation");
  } catch (const std::exception& error) {
    return fail(mbs::printable(error.what(), 2000));
  }
}
