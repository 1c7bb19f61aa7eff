// Child processes through the shell, with their output in files.
#include "support/program.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace mbs::test {

ProgramResult run_program(const std::string& program, const std::string& arguments,
                          const std::string& environment) {
  const std::string out = temporary_path("stdout"), err = temporary_path("stderr");
  const std::string command = environment + " '" + program + "' " + arguments + " > '" + out +
                              "' 2> '" + err + "' < /dev/null";
  const int status = std::system(command.c_str());
  ProgramResult result{WIFEXITED(status) ? WEXITSTATUS(status) : -1, file_text(out),
                       file_text(err)};
  std::filesystem::remove(out);
  std::filesystem::remove(err);
  return result;
}

ProgramResult run_mbs(const std::string& arguments, const std::string& environment) {
  return run_program(MBS_PROGRAM, arguments, environment);
}

std::string temporary_path(const std::string& name) {
  static int count = 0;
  return ::testing::TempDir() + "mbs_" + std::to_string(getpid()) + "_" + std::to_string(++count) +
         "_" + name;
}

std::string file_text(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::size_t memory_of_this() {
  std::size_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  return pages * static_cast<std::size_t>(::sysconf(_SC_PAGE_SIZE));
}

}  // namespace mbs::test
