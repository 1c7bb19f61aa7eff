// The program `mbs`: list, describe, simulate, check, bench.
#include <fmt/format.h>

#include <cstdio>
#include <exception>

#include "environment/environment.hpp"
#include "mbs/commands.hpp"

int main(int argc, char** argv) {
  try {
    mbs::single_thread_environment(argv);
    return mbs::run_program(argc, argv);
  } catch (const std::exception& error) {
    fmt::print(stderr, "mbs: {}\n", error.what());
    return 2;
  }
}
