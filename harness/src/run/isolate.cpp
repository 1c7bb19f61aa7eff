// fork, resource limits, a pipe and a deadline.
#include "run/isolate.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <new>
#include <stdexcept>

namespace mbs {
namespace {

constexpr int kThrew = 97;
constexpr int kOutOfMemory = 98;

#if defined(__SANITIZE_ADDRESS__)
constexpr bool kLimitMemory = false;  // the sanitizer reserves terabytes of address space
#else
constexpr bool kLimitMemory = true;
#endif

void write_all(int descriptor, const std::string& text) {
  std::size_t done = 0;
  while (done < text.size()) {
    const ssize_t count = ::write(descriptor, text.data() + done, text.size() - done);
    if (count <= 0) ::_exit(1);
    done += static_cast<std::size_t>(count);
  }
}

[[noreturn]] void child(const std::function<std::string()>& work, const IsolationLimits& limits,
                        int descriptor) {
  if (kLimitMemory) {
    const rlimit memory{limits.bytes, limits.bytes};
    ::setrlimit(RLIMIT_AS, &memory);
  }
  const rlimit no_core{0, 0};
  ::setrlimit(RLIMIT_CORE, &no_core);
  try {
    write_all(descriptor, work());
    ::_exit(0);
  } catch (const std::bad_alloc&) {
    ::_exit(kOutOfMemory);
  } catch (const std::exception& error) {
    write_all(descriptor, error.what());
    ::_exit(kThrew);
  }
}

/// Reads until the child closes the pipe; false if the deadline comes first.
bool read_until(int descriptor, std::chrono::steady_clock::time_point deadline, std::string& text) {
  std::array<char, 65536> buffer;
  while (true) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(
        deadline - std::chrono::steady_clock::now());
    if (left.count() <= 0) return false;
    pollfd ready{descriptor, POLLIN, 0};
    const int wait = static_cast<int>(std::min<long>(left.count(), 1000));
    if (::poll(&ready, 1, wait) <= 0) continue;
    const ssize_t count = ::read(descriptor, buffer.data(), buffer.size());
    if (count <= 0) return true;
    text.append(buffer.data(), static_cast<std::size_t>(count));
  }
}

Isolated interpret(int status, std::string text, const IsolationLimits& limits) {
  if (WIFSIGNALED(status)) {
    const int signal = WTERMSIG(status);
    return {Fate::crashed, fmt::format("killed by signal {} ({})", signal, ::strsignal(signal)), ""};
  }
  switch (WEXITSTATUS(status)) {
    case 0: return {Fate::finished, "", std::move(text)};
    case kThrew: return {Fate::threw, std::move(text), ""};
    case kOutOfMemory:
      return {Fate::out_of_memory,
              fmt::format("needs more than the memory limit of {} MiB", limits.bytes >> 20), ""};
    default:
      return {Fate::crashed, fmt::format("exited with status {}", WEXITSTATUS(status)), ""};
  }
}

}  // namespace

Isolated run_isolated(const std::function<std::string()>& work, const IsolationLimits& limits) {
  std::array<int, 2> ends;
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) throw std::runtime_error("no pipe to a child process");
  std::fflush(nullptr);
  const pid_t pid = ::fork();
  if (pid < 0) throw std::runtime_error("no child process could be started");
  if (pid == 0) {
    ::close(ends[0]);
    child(work, limits, ends[1]);
  }
  ::close(ends[1]);
  std::string text;
  const auto deadline =
      std::chrono::steady_clock::now() +
      std::chrono::duration_cast<std::chrono::milliseconds>(
          std::chrono::duration<double>(limits.seconds));
  const bool in_time = read_until(ends[0], deadline, text);
  if (!in_time) ::kill(pid, SIGKILL);
  ::close(ends[0]);
  int status = 0;
  ::waitpid(pid, &status, 0);
  if (!in_time) {
    return {Fate::timeout, fmt::format("did not finish within {:g} s", limits.seconds), ""};
  }
  return interpret(status, std::move(text), limits);
}

}  // namespace mbs
