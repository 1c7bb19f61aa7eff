// Write beside, then rename.
#include "atomic_file.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <utility>

#include "usage_error.hpp"

namespace mbs {

AtomicFile::AtomicFile(std::string path) : path_(std::move(path)), partial_(path_ + ".partial") {
  // A rename would replace a device such as /dev/stdout by a file: write to it directly.
  if (std::filesystem::exists(path_) && !std::filesystem::is_regular_file(path_)) partial_ = path_;
  if (path_.empty() || std::filesystem::is_directory(path_)) {
    throw UsageError(fmt::format("cannot write '{}': it is not a file name", path_));
  }
  stream_.open(partial_, std::ios::binary);
  if (!stream_) {
    throw UsageError(fmt::format("cannot write '{}': {}", path_, std::strerror(errno)));
  }
}

AtomicFile::~AtomicFile() {
  if (partial_.empty() || partial_ == path_) return;
  stream_.close();
  std::error_code ignored;
  std::filesystem::remove(partial_, ignored);
}

void AtomicFile::commit() {
  stream_.close();
  std::error_code error;
  if (stream_.fail()) error = std::make_error_code(std::errc::no_space_on_device);
  if (!error && partial_ != path_) std::filesystem::rename(partial_, path_, error);
  if (error) throw UsageError(fmt::format("cannot write '{}': {}", path_, error.message()));
  partial_.clear();
}

}  // namespace mbs
