// Refuses what would block or surprise.
#include "mbs/bench_output.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "usage_error.hpp"

namespace mbs {
namespace {

namespace fs = std::filesystem;

/// Whether it names what is open already: a pipe with both its ends, or a file to be kept.
bool is_open_already(const std::string& path) {
  return path == "/dev/stdout" || path == "/dev/stderr" || path.starts_with("/dev/fd/") ||
         path.starts_with("/proc/self/fd/");
}

}  // namespace

BenchOutput::BenchOutput(const std::string& out) : path_(out) {
  if (out.empty()) return;
  const auto refuse = [&out](const std::string& why) {
    throw UsageError(fmt::format("--benchmark_out={}: cannot be written ({})", out, why));
  };
  if (out == "-") refuse("it is no file; --benchmark_format=json writes to standard output");
  std::error_code error;
  const fs::file_status status = fs::status(out, error);
  if (fs::is_directory(status)) refuse("it is a directory");
  const bool direct = is_open_already(out) || fs::is_character_file(status);
  if (!direct && fs::exists(status) && !fs::is_regular_file(status)) {
    refuse("it is neither a file nor a character device");
  }
  if (!direct) {
    path_ += ".partial";
    rename_to_ = out;
  }
  // Opening it fails the same way in the library, which then leaves by exit().
  if (!std::ofstream(path_, std::ios::app)) refuse(std::strerror(errno));
}

void BenchOutput::finish(bool complete) const {
  std::error_code error;
  if (!rename_to_.empty() && complete) fs::rename(path_, rename_to_, error);
  if (!path_.empty() && (!complete || error)) {
    throw UsageError(fmt::format("--benchmark_out: {} could not be written to its end", path_));
  }
}

}  // namespace mbs
