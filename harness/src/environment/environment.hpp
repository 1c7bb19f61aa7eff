// What a result was obtained with: one thread, and a record of build, machine and libraries.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace mbs {

/// Gives this process the environment that every result is obtained in: one thread in every BLAS
/// and OpenMP (all of thread_variables() are "1"), and the BLAS and LAPACK that --blas asks for. If
/// anything of it differs, sets it and executes the program again. To be called first in main(),
/// before a library could have started threads.
/// @param argv the program's arguments, null-terminated
/// Throws UsageError if the program cannot be executed again, --blas cannot be had, or without it
/// another BLAS or LAPACK than the system's is loaded too.
void settle_environment(int argc, char** argv);

/// OMP_NUM_THREADS and the others that must be "1".
const std::vector<std::string>& thread_variables();

/// Names and values, in a fixed order.
using EnvironmentRecord = std::vector<std::pair<std::string, std::string>>;

/// The record that goes into every result: mbs_version, commit, dirty, compiler, flags, build_type,
/// blas (the pair that --blas asked for, or "system"), blas_loaded (files mapped into this process,
/// separated by ';'), libraries, cpu_model, machine (a
/// short hash), kernel, threads_environment and command. What cannot be found out is "unknown".
/// Neither host names nor home directories are in it.
EnvironmentRecord environment_record();

/// `text` with home directories written as "~".
std::string without_home(std::string text);

/// One line for a command: the program's and other absolute paths shortened to their last part, or
/// to the part below the working directory.
std::string command_line(const std::vector<std::string>& arguments);

/// The mapped files of this process named like a BLAS or LAPACK library.
std::vector<std::string> loaded_blas_files();

/// The mapped files named like a BLAS or LAPACK library in the text of a /proc/<pid>/maps, each
/// once.
std::vector<std::string> blas_files(const std::string& maps);

}  // namespace mbs
