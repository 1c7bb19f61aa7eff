// Processes that count in shared memory: nobody waits for another to be told what is next.
#include "sweep/job_pool.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <semaphore.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <memory>
#include <new>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <vector>

#include "usage_error.hpp"

namespace mbs {
namespace {

constexpr int kShowEvery = 200;  // ms
constexpr useconds_t kWait = 500;  // us, until the others may have prepared the rest

[[noreturn]] void fail_jobs(const char* what) {
  throw std::runtime_error(fmt::format("--jobs: {}: {}", what, std::strerror(errno)));
}

/// How far a process has come; read by this one when it has ended.
struct Course {
  enum class End : char { none, done, usage_error, no_memory, failure } end = End::none;
  std::size_t place = 0;          ///< among the blocks: of the one that it is at, or that threw
  std::array<char, 2048> text{};  ///< of what was thrown

  void finish(End how, const char* what) {
    std::string_view(what).copy(text.data(), text.size() - 1);
    end = how;
  }
  [[noreturn]] void rethrow() const {
    if (end == End::usage_error) throw UsageError(text.data());
    if (end == End::no_memory) throw std::bad_alloc();
    throw std::runtime_error(text.data());
  }
};

/// Memory of all processes; behind it a flag a block.
struct Shared {
  explicit Shared(std::size_t count) : blocks(count) {}
  [[nodiscard]] static std::size_t bytes(std::size_t blocks) {
    return sizeof(Shared) + blocks * sizeof(std::atomic_flag);
  }
  /// Whether nobody else has it.
  [[nodiscard]] bool claim(std::size_t place) {
    return !is_over && !reinterpret_cast<std::atomic_flag*>(this + 1)[place].test_and_set();
  }

  std::size_t blocks;
  std::atomic<std::size_t> next{0}, prepared{0}, kept{0};
  std::atomic<bool> is_over{false};  // something went wrong
  std::array<Course, kMostJobs> courses{};
  sem_t keeping{};
};

struct Unmap {
  void operator()(Shared* shared) const { ::munmap(shared, Shared::bytes(shared->blocks)); }
};

std::unique_ptr<Shared, Unmap> create_shared(std::size_t blocks) {
  void* memory = ::mmap(nullptr, Shared::bytes(blocks), PROT_READ | PROT_WRITE,
                        MAP_SHARED | MAP_ANONYMOUS, -1, 0);  // zero, as flags that are clear
  if (memory == MAP_FAILED) fail_jobs("no memory");
  std::unique_ptr<Shared, Unmap> shared(new (memory) Shared(blocks));
  if (::sem_init(&shared->keeping, /*pshared=*/1, 1) != 0) fail_jobs("no semaphore");
  return shared;
}

/// While it lives, no other process has one.
class Alone {
 public:
  explicit Alone(sem_t& semaphore) : semaphore_(semaphore) {
    while (::sem_wait(&semaphore_) != 0) {  // a signal came
    }
  }
  ~Alone() { ::sem_post(&semaphore_); }
  Alone(const Alone&) = delete;
  Alone& operator=(const Alone&) = delete;

 private:
  sem_t& semaphore_;
};

/// A process; ends when it is destroyed.
class Job {
 public:
  explicit Job(const std::function<void()>& run) {
    const pid_t parent = ::getpid();
    process_ = ::fork();
    if (process_ < 0) fail_jobs("no process");
    if (process_ == 0) {
      for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        if (::signal(signal, SIG_DFL) == SIG_IGN) ::signal(signal, SIG_IGN);  // nohup
      }
      ::prctl(PR_SET_PDEATHSIG, SIGKILL);  // nothing goes on where the program is killed ...
      if (::getppid() == parent) run();    // ... or was, a moment ago
      ::_exit(0);
    }
    handle_ = static_cast<int>(::syscall(SYS_pidfd_open, process_, 0));
    if (handle_ < 0) fail_jobs("no handle");
  }
  ~Job() {
    if (process_ < 0) return;
    ::kill(process_, SIGKILL);  // what it would give is not wanted
    wait();
  }
  Job(const Job&) = delete;
  Job& operator=(const Job&) = delete;

  /// Can be read when the process ends; negative then.
  [[nodiscard]] int handle() const { return handle_; }

  /// Its status.
  int wait() {
    int status = 0;
    ::waitpid(std::exchange(process_, -1), &status, 0);
    ::close(std::exchange(handle_, -1));
    return status;
  }

 private:
  pid_t process_ = -1;
  int handle_ = -1;
};

}  // namespace

void for_blocks(int jobs, std::span<const long> blocks,
                const std::function<std::string(long)>& work,
                const std::function<void(long, const std::string&)>& keep,
                const std::function<void(std::size_t, std::size_t)>& show,
                const std::function<void(long)>& prepare) {
  const std::size_t count = blocks.size();
  if (jobs == 1 || count < 2) {
    for (std::size_t i = 0; prepare && i < count; show(++i, 0)) prepare(blocks[i]);
    for (std::size_t i = 0; i < count; show(count, ++i)) keep(blocks[i], work(blocks[i]));
    return;
  }
  const auto shared = create_shared(count);
  const auto prepare_some = [&](Course& course) {
    std::vector<std::size_t> mine;
    for (std::size_t place = 0; !shared->is_over && (place = shared->next++) < count;) {
      prepare(blocks[course.place = place]);
      mine.push_back(place);
      ++shared->prepared;
    }
    while (!shared->is_over && shared->prepared < count) ::usleep(kWait);
    return mine;
  };
  const auto take = [&](std::size_t place, Course& course) {
    const long block = blocks[course.place = place];
    const std::string result = work(block);
    const Alone turn(shared->keeping);
    keep(block, result);
    ++shared->kept;
  };
  const auto run = [&](Course& course) {
    using enum Course::End;
    try {
      if (prepare) {
        std::vector<std::size_t> places = prepare_some(course);
        // Then what others have not come to, their last first.
        for (std::size_t place = count; place-- > 0;) places.push_back(place);
        for (const std::size_t place : places) {
          if (shared->claim(place)) take(place, course);
        }
      }
      for (std::size_t place = 0; !shared->is_over && (place = shared->next++) < count;) {
        take(place, course);
      }
      return course.finish(done, "");
    } catch (const UsageError& error) {
      course.finish(usage_error, error.what());
    } catch (const std::bad_alloc& error) {
      course.finish(no_memory, error.what());
    } catch (const std::exception& error) {
      course.finish(failure, error.what());
    }
    shared->is_over = true;
  };
  std::fflush(nullptr);
  std::vector<std::unique_ptr<Job>> pool;
  while (pool.size() < std::min(static_cast<std::size_t>(jobs), count)) {
    Course& course = shared->courses[pool.size()];
    pool.push_back(std::make_unique<Job>([&] { run(course); }));
  }
  const Course* first = nullptr;
  for (std::size_t running = pool.size(); running > 0; show(shared->prepared, shared->kept)) {
    std::vector<pollfd> waited;
    for (const auto& job : pool) waited.push_back({job->handle(), POLLIN, 0});
    if (::poll(waited.data(), waited.size(), kShowEvery) < 0 && errno != EINTR) fail_jobs("no news");
    for (std::size_t i = 0; i < pool.size(); ++i) {
      if (waited[i].revents == 0) continue;
      const int status = pool[i]->wait();
      const Course& course = shared->courses[i];
      --running;
      if (course.end == Course::End::none) {
        throw UsageError(fmt::format("a process of --jobs ended in block {} ({}); what was done stays for --resume",
                                     blocks[course.place], WIFSIGNALED(status) ? ::strsignal(WTERMSIG(status)) : "exit"));
      }
      if (course.end != Course::End::done && (first == nullptr || course.place < first->place)) first = &course;
    }
  }
  if (first != nullptr) first->rethrow();
}

}  // namespace mbs
