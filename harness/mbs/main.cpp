// The program `mbs`: list, describe, simulate, check, bench.
#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <new>

#include "environment/environment.hpp"
#include "mbs/commands.hpp"

int main(int argc, char** argv) {
  try {
    mbs::single_thread_environment(argv);
    return mbs::run_program(argc, argv);
  } catch (const std::bad_alloc&) {
    fmt::print(stderr, "mbs: not enough memory for this scene with this implementation\n");
    return 2;
  } catch (const std::exception& error) {
    fmt::print(stderr, "mbs: {}\n", error.what());
    return 2;
  }
}
