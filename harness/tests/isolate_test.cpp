// Child processes: whatever work does to itself, the parent goes on and says what happened.
#include "run/isolate.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "support/program.hpp"

namespace mbs {
namespace {

constexpr IsolationLimits kShortLimits{.seconds = 0.3};

double seconds_of(const std::function<void()>& action) {
  const auto begin = std::chrono::steady_clock::now();
  action();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

long open_descriptors() {
  long count = 0;
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd")) {
    (void)entry;
    ++count;
  }
  return count;
}

/// Waits up to five seconds for the process to be gone, or a zombie that another must reap.
bool disappears(pid_t pid) {
  for (int i = 0; i < 500; ++i) {
    std::ifstream stat("/proc/" + std::to_string(pid) + "/stat");
    std::string number, name, state;
    if (!(stat >> number >> name >> state) || state == "Z") return true;
    ::usleep(10'000);
  }
  return false;
}

TEST(Isolate, ReturnsWhatTheWorkReturns) {
  for (const std::string& text :
       {std::string(), std::string("one"), std::string("a\0b\n\xff", 5)}) {
    const Isolated result = run_isolated([&] { return text; });
    EXPECT_EQ(result.fate, Fate::finished) << result.reason;
    EXPECT_EQ(result.output, text);
    EXPECT_EQ(result.reason, "");
  }
}

TEST(Isolate, ReturnsMoreThanAPipeHolds) {
  const Isolated result = run_isolated([] { return std::string(20'000'000, 'x'); });
  ASSERT_EQ(result.fate, Fate::finished) << result.reason;
  EXPECT_EQ(result.output, std::string(20'000'000, 'x'));
}

TEST(Isolate, ChangesNothingInTheParent) {
  int value = 1;
  run_isolated([&] {
    value = 2;
    return std::string();
  });
  EXPECT_EQ(value, 1);
}

TEST(Isolate, TellsWhatWasThrown) {
  Isolated result =
      run_isolated([]() -> std::string { throw std::runtime_error("no\nluck \xff"); });
  EXPECT_EQ(result.fate, Fate::threw);
  EXPECT_EQ(result.reason, "no\\x0Aluck \\xFF");
  result = run_isolated([]() -> std::string { throw 1; });
  EXPECT_EQ(result.fate, Fate::threw);
  result = run_isolated([]() -> std::string { throw std::bad_alloc(); });
  EXPECT_EQ(result.fate, Fate::out_of_memory);
}

TEST(Isolate, ExitIsNoResult) {
  for (const int status : {0, 1, 97, 98}) {
    const Isolated result = run_isolated([&]() -> std::string { ::_exit(status); });
    EXPECT_EQ(result.fate, Fate::crashed);
    EXPECT_EQ(result.reason, "exited with status " + std::to_string(status) + " before its result");
  }
  if (MBS_SANITIZE) return;  // whose report of leaks changes the status
  EXPECT_EQ(run_isolated([]() -> std::string { std::exit(0); }).fate, Fate::crashed);
}

TEST(Isolate, NamesTheSignal) {
  for (const int signal : {SIGKILL, SIGTERM, SIGABRT, SIGFPE, SIGBUS, SIGXCPU}) {
    const Isolated result = run_isolated([&]() -> std::string {
      std::signal(signal, SIG_DFL);
      ::raise(signal);
      return "survived";
    });
    EXPECT_EQ(result.fate, Fate::crashed);
    EXPECT_TRUE(result.reason.starts_with("killed by signal " + std::to_string(signal) + " ("))
        << result.reason;
  }
}

TEST(Isolate, KillsWhatHangs) {
  const double seconds = seconds_of([] {
    const Isolated result = run_isolated(
        []() -> std::string {
          std::signal(SIGTERM, SIG_IGN);
          while (true) ::pause();
        },
        kShortLimits);
    EXPECT_EQ(result.fate, Fate::timeout);
    EXPECT_EQ(result.reason, "did not finish within 0.3 s");
  });
  EXPECT_GE(seconds, 0.3);
  EXPECT_LT(seconds, 10.0);
}

TEST(Isolate, KillsWhatIsStopped) {
  const Isolated result = run_isolated(
      []() -> std::string {
        ::raise(SIGSTOP);
        return "";
      },
      kShortLimits);
  EXPECT_EQ(result.fate, Fate::timeout);
}

TEST(Isolate, ClosingThePipeDoesNotEscapeTheLimit) {
  const double seconds = seconds_of([] {
    const Isolated result = run_isolated(
        []() -> std::string {
          for (int descriptor = 3; descriptor < 256; ++descriptor) ::close(descriptor);
          while (true) ::pause();
        },
        kShortLimits);
    EXPECT_EQ(result.fate, Fate::timeout);
  });
  EXPECT_LT(seconds, 10.0);
}

/// Starts a process of its own that keeps all descriptors and sleeps; its id is in the output.
std::string leave_someone_behind() {
  const pid_t pid = ::fork();
  if (pid == 0) {
    ::sleep(60);
    ::_exit(0);
  }
  return std::to_string(pid);
}

TEST(Isolate, LeavesNoGrandchildBehind) {
  Isolated result;
  EXPECT_LT(seconds_of([&] { result = run_isolated(leave_someone_behind, {.seconds = 50}); }),
            40.0);
  ASSERT_EQ(result.fate, Fate::finished) << result.reason;
  EXPECT_TRUE(disappears(std::stoi(result.output)));
}

TEST(Isolate, LeavesNoGrandchildBehindAfterACrashOrATimeout) {
  const std::string path = test::temporary_path("pid");
  for (const bool hangs : {false, true}) {
    const auto work = [&]() -> std::string {
      std::ofstream(path) << leave_someone_behind();
      while (hangs) ::pause();
      ::raise(SIGKILL);
      return "";
    };
    const double seconds = hangs ? 2.0 : 60.0;
    EXPECT_EQ(run_isolated(work, {.seconds = seconds}).fate, hangs ? Fate::timeout : Fate::crashed);
    EXPECT_TRUE(disappears(std::stoi(test::file_text(path))));
  }
  std::filesystem::remove(path);
}

TEST(Isolate, TakesOneResultOfAForkedWork) {
  const Isolated result = run_isolated([]() -> std::string {
    if (::fork() < 0) return "no fork";
    return "done";
  });
  EXPECT_EQ(result.fate, Fate::finished);
  EXPECT_EQ(result.output, "done");
}

/// Runs `action` in a process of its own and returns its id.
template <class Action>
pid_t start(Action action) {
  const pid_t pid = ::fork();
  if (pid == 0) {
    action();
    ::_exit(0);
  }
  return pid;
}

TEST(Isolate, TheChildDiesWithItsParent) {
  const std::string path = test::temporary_path("pid");
  const pid_t parent = start([&] {
    run_isolated([&]() -> std::string {
      std::ofstream(path) << ::getpid() << ' ';
      while (true) ::pause();
    });
  });
  for (int i = 0; i < 500 && !test::file_text(path).ends_with(' '); ++i) ::usleep(10'000);
  ASSERT_TRUE(test::file_text(path).ends_with(' '));
  ::kill(parent, SIGKILL);
  ::waitpid(parent, nullptr, 0);
  EXPECT_TRUE(disappears(std::stoi(test::file_text(path))));
  std::filesystem::remove(path);
}

TEST(Isolate, KnowsTheFateEvenIfSigchldIsIgnored) {
  const auto before = std::signal(SIGCHLD, SIG_IGN);
  EXPECT_EQ(run_isolated([] { return std::string("x"); }, {.seconds = 60}).fate, Fate::finished);
  EXPECT_EQ(run_isolated([]() -> std::string { ::_exit(3); }, {.seconds = 60}).fate, Fate::crashed);
  std::signal(SIGCHLD, before);
}

TEST(Isolate, PrintedTextStaysOutOfTheParentsOutput) {
  testing::internal::CaptureStdout();
  std::fputs("before", stdout);  // buffered: must not come twice
  const Isolated result = run_isolated([] {
    std::fputs("child", stdout);
    std::fflush(stdout);
    return std::string("x");
  });
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "before");
  EXPECT_EQ(result.output, "x");
}

TEST(Isolate, AnOutputFloodIsCutByTheLimit) {
  const Isolated result = run_isolated(
      []() -> std::string {
        const std::string noise(1 << 16, '.');
        while (true) {
          if (::write(STDOUT_FILENO, noise.data(), noise.size()) < 0) return "could not write";
        }
      },
      kShortLimits);
  EXPECT_EQ(result.fate, Fate::timeout);
}

TEST(Isolate, LimitsMemory) {
  if (MBS_SANITIZE) GTEST_SKIP() << "sanitizers reserve terabytes: no memory limit is set";
  const auto take = [](std::size_t bytes) {
    return [bytes] {
      const std::string text(bytes, 'x');
      return text.substr(0, 1);
    };
  };
  const IsolationLimits limits{.seconds = 20,
                               .bytes = test::memory_of_this() + (std::size_t{256} << 20)};
  EXPECT_EQ(run_isolated(take(std::size_t{64} << 20), limits).fate, Fate::finished);
  const Isolated result = run_isolated(take(limits.bytes), limits);
  EXPECT_EQ(result.fate, Fate::out_of_memory);
  EXPECT_EQ(result.reason,
            "needs more than the memory limit of " + std::to_string(limits.bytes >> 20) + " MiB");
}

TEST(Isolate, LeaksNoDescriptorsAndNoProcesses) {
  run_isolated([] { return std::string(); });
  const long before = open_descriptors();
  const int runs = MBS_SANITIZE ? 300 : 2000;
  for (int i = 0; i < runs; ++i) {
    const Isolated result = run_isolated([i]() -> std::string {
      if (i % 3 == 1) ::_exit(1);
      if (i % 3 == 2) throw std::runtime_error("third");
      return std::to_string(i);
    });
    if (i % 3 == 0) {
      ASSERT_EQ(result.output, std::to_string(i));
    }
  }
  EXPECT_EQ(open_descriptors(), before);
  EXPECT_EQ(::waitpid(-1, nullptr, WNOHANG), -1);  // no child is left to wait for
}

}  // namespace
}  // namespace mbs
