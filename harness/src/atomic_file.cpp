// Write beside, then rename.
#include "atomic_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <functional>
#include <system_error>
#include <utility>

#include "usage_error.hpp"

namespace mbs {
namespace {

namespace fs = std::filesystem;

/// The names that a signal handler removes; an empty one is a free place.
using Name = std::array<char, 4096>;
std::array<Name, 4> unfinished{};

void remove_and_die(int signal) {
  for (const Name& name : unfinished) {
    if (name[0] != '\0') ::unlink(name.data());
  }
  ::signal(signal, SIG_DFL);
  ::raise(signal);
}

void forget(const std::string& path) {
  for (Name& name : unfinished) {
    if (path == name.data()) name[0] = '\0';
  }
}

void remember(const std::string& path) {
  Name* free_place = std::ranges::find_if(unfinished, [](const Name& n) { return n[0] == '\0'; });
  if (free_place == unfinished.end() || path.size() >= free_place->size()) return;
  std::memcpy(free_place->data(), path.c_str(), path.size() + 1);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGPIPE, SIGXCPU}) {
    if (::signal(signal, remove_and_die) == SIG_IGN) ::signal(signal, SIG_IGN);  // nohup
  }
}

/// The descriptor that such a name stands for.
int descriptor_of(const std::string& path) {
  if (path == "/dev/stdout") return STDOUT_FILENO;
  if (path == "/dev/stderr") return STDERR_FILENO;
  return std::atoi(path.c_str() + path.rfind('/') + 1);
}

/// Whatever is written to a file that is open already goes to its end, through the descriptor too:
/// what the program prints later would else come over the beginning.
void write_at_end(const std::string& path) {
  std::fflush(nullptr);
  const int file = descriptor_of(path), flags = ::fcntl(file, F_GETFL);
  if (flags >= 0) ::fcntl(file, F_SETFL, flags | O_APPEND);
}

/// Creates a file beside `path` that nobody else has, and returns its name; empty on failure.
std::string create_beside(const std::string& path) {
  const std::size_t folder = path.rfind('/') + 1;  // its length
  const std::string begin = path.substr(0, folder) + partial_begin(path.substr(folder));
  for (int attempt = 0; attempt < 100; ++attempt) {
    const std::string name = fmt::format("{}{}-{}.partial", begin, ::getpid(), attempt);
    const int file = ::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (file < 0 && errno == EEXIST) continue;
    if (file < 0) return "";
    ::close(file);
    return name;
  }
  return "";
}

}  // namespace

std::string partial_begin(const std::string& name) {
  constexpr std::size_t kMost = 200;
  if (name.size() <= kMost) return name + '.';
  return fmt::format("{}-{:x}.", name.substr(0, kMost), std::hash<std::string>{}(name));
}

bool is_open_already(const std::string& path) {
  return path == "/dev/stdout" || path == "/dev/stderr" || path.starts_with("/dev/fd/") ||
         path.starts_with("/proc/self/fd/");
}

AtomicFile::AtomicFile(std::string path) : name_(path), path_(std::move(path)) {
  const auto refuse = [this](const char* why) {
    throw UsageError(fmt::format("cannot write '{}': {}", name_, why));
  };
  std::error_code error;
  const fs::file_status status = fs::status(path_, error);
  if (path_.empty() || path_ == "-" || fs::is_directory(status)) refuse("it is not a file name");
  if (status.type() == fs::file_type::none) refuse(error.message().c_str());
  const bool open_already = is_open_already(path_);
  if (!open_already && (fs::is_fifo(status) || fs::is_socket(status))) {
    refuse("it is a pipe or a socket");
  }
  // A rename would replace a link; and a device must be written to directly.
  if (fs::exists(status) && !open_already) path_ = fs::canonical(path_).string();
  while (!fs::exists(status) && fs::is_symlink(path_)) {
    path_ = (fs::path(path_).parent_path() / fs::read_symlink(path_)).string();
  }
  const bool direct = open_already || (fs::exists(status) && !fs::is_regular_file(status));
  partial_ = direct ? path_ : create_beside(path_);
  if (partial_.empty()) refuse(std::strerror(errno));
  if (!direct) remember(partial_);
  if (open_already) write_at_end(path_);
  stream_.open(partial_, std::ios::binary | (open_already ? std::ios::app : std::ios::out));
  if (!stream_) refuse(std::strerror(errno));
}

AtomicFile::~AtomicFile() {
  if (partial_.empty() || partial_ == path_) return;
  forget(partial_);
  stream_.close();
  std::error_code ignored;
  fs::remove(partial_, ignored);
}

void AtomicFile::commit() {
  stream_.close();
  std::error_code error;
  if (stream_.fail()) error = std::make_error_code(std::errc::no_space_on_device);
  if (!error && partial_ != path_) fs::rename(partial_, path_, error);
  if (error) throw UsageError(fmt::format("cannot write '{}': {}", name_, error.message()));
  forget(partial_);
  partial_.clear();
}

}  // namespace mbs
