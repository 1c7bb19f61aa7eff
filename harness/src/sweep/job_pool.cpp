// One pipe each way a process: the number of a block there, its result back.
#include "sweep/job_pool.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

#include "usage_error.hpp"

namespace mbs {
namespace {

enum class Message : char { result, usage_error, failure };

struct Head {
  Message kind = Message::result;
  std::size_t size = 0;
};

/// False where the other end is gone.
bool write_all(int file, const void* data, std::size_t size) {
  const char* at = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t count = ::write(file, at, size);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    at += count;
    size -= static_cast<std::size_t>(count);
  }
  return true;
}

bool read_all(int file, void* data, std::size_t size) {
  char* at = static_cast<char*>(data);
  while (size > 0) {
    const ssize_t count = ::read(file, at, size);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    at += count;
    size -= static_cast<std::size_t>(count);
  }
  return true;
}

[[noreturn]] void serve(int requests, int results, const std::function<std::string(long)>& work) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGPIPE}) ::signal(signal, SIG_DFL);
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);  // nothing goes on where the program is killed
  long block = 0;
  while (read_all(requests, &block, sizeof block)) {
    Head head;
    std::string text;
    try {
      text = work(block);
    } catch (const UsageError& error) {
      head.kind = Message::usage_error;
      text = error.what();
    } catch (const std::exception& error) {
      head.kind = Message::failure;
      text = error.what();
    }
    head.size = text.size();
    if (!write_all(results, &head, sizeof head) || !write_all(results, text.data(), text.size())) break;
  }
  ::_exit(0);
}

/// A process; ends when it is destroyed.
class Job {
 public:
  Job(const std::function<std::string(long)>& work, const std::vector<std::unique_ptr<Job>>& others) {
    std::array<int, 2> there{}, back{};
    if (::pipe(there.data()) != 0 || ::pipe(back.data()) != 0) fail("no pipe");
    process_ = ::fork();
    if (process_ < 0) fail("no process");
    if (process_ == 0) {
      for (const auto& other : others) {  // whose end must be seen when this program is killed
        ::close(other->requests_);
        ::close(other->results_);
      }
      ::close(there[1]);
      ::close(back[0]);
      serve(there[0], back[1], work);
    }
    ::close(there[0]);
    ::close(back[1]);
    requests_ = there[1];
    results_ = back[0];
  }
  ~Job() {
    ::close(requests_);
    ::close(results_);
    if (process_ < 0) return;
    if (block_ >= 0) ::kill(process_, SIGTERM);  // what it would give is not wanted
    ::waitpid(process_, nullptr, 0);
  }
  Job(const Job&) = delete;
  Job& operator=(const Job&) = delete;

  [[nodiscard]] bool is_busy() const { return block_ >= 0; }
  [[nodiscard]] int results() const { return results_; }

  void begin(long block) {
    block_ = block;
    write_all(requests_, &block, sizeof block);  // where it fails, no result will come
  }
  std::pair<long, std::string> finish() {
    Head head;
    if (!read_all(results_, &head, sizeof head)) fail_lost();
    std::string text(head.size, '\0');
    if (!read_all(results_, text.data(), text.size())) fail_lost();
    if (head.kind == Message::usage_error) throw UsageError(text);
    if (head.kind == Message::failure) throw std::runtime_error(text);
    return {std::exchange(block_, -1), std::move(text)};
  }

 private:
  [[noreturn]] static void fail(const char* what) {
    throw std::runtime_error(fmt::format("--jobs: {}: {}", what, std::strerror(errno)));
  }
  [[noreturn]] void fail_lost() {
    int status = 0;
    ::waitpid(std::exchange(process_, -1), &status, 0);
    throw UsageError(fmt::format("a process of --jobs ended in block {} ({}); what was done stays for --resume",
                                 block_, WIFSIGNALED(status) ? ::strsignal(WTERMSIG(status)) : "exit"));
  }

  pid_t process_ = -1;
  int requests_ = -1, results_ = -1;
  long block_ = -1;
};

}  // namespace

void for_blocks(int jobs, std::span<const long> blocks,
                const std::function<std::string(long)>& work,
                const std::function<bool(long, std::string)>& take) {
  if (jobs == 1 || blocks.size() < 2) {
    for (const long block : blocks) {
      if (!take(block, work(block))) return;
    }
    return;
  }
  std::fflush(nullptr);
  const auto before = ::signal(SIGPIPE, SIG_IGN);
  std::vector<std::unique_ptr<Job>> pool;
  while (pool.size() < std::min(static_cast<std::size_t>(jobs), blocks.size())) {
    pool.push_back(std::make_unique<Job>(work, pool));
  }
  std::size_t next = 0;
  bool go_on = true;
  while (true) {
    std::vector<pollfd> waited;
    std::vector<Job*> busy;
    for (const auto& job : pool) {
      if (!job->is_busy() && go_on && next < blocks.size()) job->begin(blocks[next++]);
      if (!job->is_busy()) continue;
      waited.push_back({job->results(), POLLIN, 0});
      busy.push_back(job.get());
    }
    if (busy.empty()) break;
    if (::poll(waited.data(), waited.size(), -1) < 0) {
      if (errno == EINTR) continue;
      throw std::runtime_error(fmt::format("--jobs: {}", std::strerror(errno)));
    }
    for (std::size_t i = 0; i < busy.size(); ++i) {
      if (waited[i].revents == 0) continue;
      auto [block, text] = busy[i]->finish();
      go_on = take(block, std::move(text)) && go_on;
    }
  }
  pool.clear();
  ::signal(SIGPIPE, before);
}

}  // namespace mbs
