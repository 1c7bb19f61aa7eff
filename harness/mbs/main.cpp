// The program `mbs`: list, describe, simulate, check, bench.
#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <new>

#include "environment/environment.hpp"
#include "mbs/commands.hpp"
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

}  // namespace

int main(int argc, char** argv) {
  try {
    limit_memory();
    mbs::single_thread_environment(argv);
    return mbs::run_program(argc, argv);
  } catch (const std::bad_alloc&) {
    fmt::print(stderr, "mbs: not enough memory for this scene with this implementation\n");
    return 2;
  } catch (const std::exception& error) {
    fmt::print(stderr, "mbs: {}\n", mbs::printable(error.what(), 2000));
    return 2;
  }
}
