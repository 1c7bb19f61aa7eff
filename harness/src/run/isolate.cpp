// fork, resource limits, a pipe and a deadline.
#include "run/isolate.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <new>
#include <stdexcept>
#include <string_view>

#include "printable.hpp"

namespace mbs {
namespace {

using Clock = std::chrono::steady_clock;

// What a child sends first; one that sends nothing did not come to the end of its work.
constexpr char kFinished = 'F';
constexpr char kThrew = 'T';
constexpr char kOutOfMemory = 'M';

#if defined(__SANITIZE_ADDRESS__)
constexpr bool kLimitMemory = false;  // the sanitizer reserves terabytes of address space
#else
constexpr bool kLimitMemory = true;
#endif

/// Bytes that the child may have: never more than this process itself.
std::size_t memory_limit(const IsolationLimits& limits) {
  rlimit own{};
  ::getrlimit(RLIMIT_AS, &own);
  return std::min<std::size_t>(limits.bytes, own.rlim_cur);
}

/// Sends and exits; allocates nothing, for there may be nothing left.
[[noreturn]] void send(int descriptor, char kind, std::string_view text) {
  const auto write_all = [descriptor](std::string_view left) {
    while (!left.empty()) {
      const ssize_t count = ::write(descriptor, left.data(), left.size());
      if (count <= 0) ::_exit(1);
      left.remove_prefix(static_cast<std::size_t>(count));
    }
  };
  write_all({&kind, 1});
  write_all(text);
  ::_exit(0);
}

/// Must not outlive `parent`, nor print where the parent's results go.
void confine(pid_t parent, const IsolationLimits& limits) {
  ::setpgid(0, 0);
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(1);
  const int nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
  if (nowhere >= 0) ::dup2(nowhere, STDOUT_FILENO);
  if (kLimitMemory) {
    const rlimit memory{memory_limit(limits), memory_limit(limits)};
    ::setrlimit(RLIMIT_AS, &memory);
  }
  const rlimit no_core{0, 0};
  ::setrlimit(RLIMIT_CORE, &no_core);
}

[[noreturn]] void child(const std::function<std::string()>& work, int descriptor) {
  const pid_t self = ::getpid();
  try {
    const std::string result = work();
    if (::getpid() != self) ::_exit(0);  // the work forked: only one result is wanted
    send(descriptor, kFinished, result);
  } catch (const std::bad_alloc&) {
    send(descriptor, kOutOfMemory, "");
  } catch (const std::exception& error) {
    send(descriptor, kThrew, error.what());
  } catch (...) {
    send(descriptor, kThrew, "something that is not a std::exception");
  }
}

/// True if the child has ended; it is not reaped yet, so that its process group stays its own.
bool has_ended(pid_t pid) {
  siginfo_t info{};
  return ::waitid(P_PID, static_cast<id_t>(pid), &info, WEXITED | WNOHANG | WNOWAIT) == 0 &&
         info.si_pid == pid;
}

/// Appends what is there, a buffer at most; false if that was nothing.
bool read_some(int descriptor, std::string& text) {
  std::array<char, 65536> buffer;
  const ssize_t count = ::read(descriptor, buffer.data(), buffer.size());
  if (count > 0) text.append(buffer.data(), static_cast<std::size_t>(count));
  return count > 0;
}

/// Reads until the child ends; false if the deadline comes first. The end of the pipe is no
/// measure: a child may close it and go on, and a child of its own may keep it open.
bool read_to_end(pid_t pid, int descriptor, Clock::time_point deadline, std::string& text) {
  while (!has_ended(pid)) {
    if (Clock::now() >= deadline) return false;
    pollfd ready{descriptor, POLLIN, 0};
    const bool any = ::poll(&ready, 1, 5) > 0;
    if (any && !read_some(descriptor, text)) ::usleep(500);  // closed: poll no longer waits
  }
  ::kill(-pid, SIGKILL);  // what it leaves behind
  while (Clock::now() < deadline && read_some(descriptor, text)) continue;
  return true;
}

Isolated interpret(int status, const std::string& text, const IsolationLimits& limits) {
  if (WIFSIGNALED(status)) {
    const int signal = WTERMSIG(status);
    return {Fate::crashed, fmt::format("killed by signal {} ({})", signal, ::strsignal(signal)),
            ""};
  }
  if (WEXITSTATUS(status) != 0 || text.empty()) {
    return {Fate::crashed,
            fmt::format("exited with status {} before its result", WEXITSTATUS(status)), ""};
  }
  switch (text[0]) {
    case kFinished:
      return {Fate::finished, "", text.substr(1)};
    case kOutOfMemory:
      return {Fate::out_of_memory,
              fmt::format("needs more than the memory limit of {} MiB", memory_limit(limits) >> 20),
              ""};
    case kThrew:
      return {Fate::threw, printable(std::string_view(text).substr(1), 1000), ""};
  }
  // What an implementation wrote to a descriptor that is not its own.
  return {Fate::crashed, "exited with a result that cannot be read", ""};
}

}  // namespace

Isolated run_isolated(const std::function<std::string()>& work, const IsolationLimits& limits) {
  std::array<int, 2> ends;
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) throw std::runtime_error("no pipe to a child process");
  std::signal(SIGCHLD, SIG_DFL);  // if ignored, the kernel would drop the child's status
  std::fflush(nullptr);
  const pid_t parent = ::getpid();
  const pid_t pid = ::fork();
  if (pid == 0) {
    confine(parent, limits);
    ::close(ends[0]);
    child(work, ends[1]);
  }
  ::close(ends[1]);
  if (pid < 0) {
    ::close(ends[0]);
    throw std::runtime_error("no child process could be started");
  }
  ::setpgid(pid, pid);  // here too, so that it has happened whoever comes first
  ::fcntl(ends[0], F_SETFL, O_NONBLOCK);
  const auto deadline = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                           std::chrono::duration<double>(limits.seconds));
  std::string text;
  const bool in_time = read_to_end(pid, ends[0], deadline, text);
  if (!in_time) ::kill(-pid, SIGKILL);
  ::close(ends[0]);
  int status = 0;
  while (::waitpid(pid, &status, 0) < 0 && errno == EINTR) continue;
  if (!in_time) {
    return {Fate::timeout, fmt::format("did not finish within {:g} s", limits.seconds), ""};
  }
  return interpret(status, text, limits);
}

}  // namespace mbs
