// Runs the program `mbs` as its users do.
#pragma once

#include <cstddef>
#include <string>

namespace mbs::test {

struct ProgramResult {
  int status = -1;     ///< exit status, or -1 if it did not exit by itself
  std::string output;  ///< of stdout
  std::string errors;  ///< of stderr
};

/// Runs `<program> <arguments>` through the shell, with `environment` ("NAME=value ...") in front.
ProgramResult run_program(const std::string& program, const std::string& arguments,
                          const std::string& environment = "");

/// The same with `mbs` as the program.
ProgramResult run_mbs(const std::string& arguments, const std::string& environment = "");

/// A path in the tests' temporary folder that no other test of this or another process uses.
std::string temporary_path(const std::string& name);

/// The whole text of a file; empty if there is none.
std::string file_text(const std::string& path);

/// Bytes of address space that this process has by now, and a child from its start on.
std::size_t memory_of_this();

}  // namespace mbs::test
