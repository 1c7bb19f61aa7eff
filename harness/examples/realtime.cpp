// A loop in real time: ./realtime car.json [SECONDS] [IMPLEMENTATION]; how long steps take, and
// which come too late.
#include <sched.h>
#include <sys/mman.h>
#include <time.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <mbs/stepper.hpp>
#include <string>

namespace {

constexpr long kSecond = 1'000'000'000;

timespec now() {
  timespec time{};
  clock_gettime(CLOCK_MONOTONIC, &time);
  return time;
}

/// Nanoseconds from `a` to `b`.
long between(const timespec& a, const timespec& b) {
  return (b.tv_sec - a.tv_sec) * kSecond + (b.tv_nsec - a.tv_nsec);
}

timespec later(timespec time, long nanoseconds) {
  time.tv_nsec += nanoseconds;
  time.tv_sec += time.tv_nsec / kSecond;
  time.tv_nsec %= kSecond;
  return time;
}

/// What a process can ask of the machine; a plain user is refused some of it, and the loop runs all
/// the same.
void ask_for_real_time() {
  sched_param parameters{};
  parameters.sched_priority = sched_get_priority_max(SCHED_FIFO) / 2;
  const bool has_priority = sched_setscheduler(0, SCHED_FIFO, &parameters) == 0;
  const bool is_locked = mlockall(MCL_CURRENT | MCL_FUTURE) == 0;
  std::printf("SCHED_FIFO: %s, mlockall: %s\n", has_priority ? "yes" : "refused",
              is_locked ? "yes" : "refused");
}

/// In microseconds; `times` are nanoseconds.
void print(const char* what, std::vector<long> times) {
  std::ranges::sort(times);
  const auto at = [&](double share) {
    return static_cast<double>(
               times[static_cast<std::size_t>(share * static_cast<double>(times.size() - 1))]) /
           1e3;
  };
  std::printf("%-22s median %8.1f us, 99 %% %8.1f us, longest %8.1f us\n", what, at(0.5), at(0.99),
              at(1.0));
}

/// `text` as a number; `what` it is, for messages.
double number(const char* what, const char* text) {
  char* end = nullptr;
  const double value = std::strtod(text, &end);
  if (end != text && *end == '\0') return value;
  throw mbs::Refused(std::string(what) + ": found '" + text + "', allowed is a number");
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc < 2) throw mbs::Refused("realtime SCENE [SECONDS] [IMPLEMENTATION]");
  const double seconds = argc > 2 ? number("SECONDS", argv[2]) : 5.0;
  mbs::StepperOptions options{.implementation = argc > 3 ? argv[3] : "auto"};
  options.settings.step = 1e-3;
  options.settings.max_passes = 6;  // bounds the longest step; far more than are usual
  mbs::Stepper car(mbs::SceneDocument::load(argv[1]), options);
  const int wheel = car.input("road FL");
  const long period = std::lround(car.settings().step * kSecond);
  if (!(seconds >= car.settings().step)) throw mbs::Refused("SECONDS: a step or more");
  const auto steps = static_cast<std::size_t>(std::lround(seconds / car.settings().step));
  std::vector<long> working, waking;  // filled in the loop, so that it allocates nothing
  working.reserve(steps);
  waking.reserve(steps);
  mbs::Saved start;
  car.save(start);
  if (car.step(100).status == mbs::StepStatus::factorization_failed)
    throw std::runtime_error("a step failed");
  car.restore(start);  // pages and caches are warm, and the car stands at its start
  ask_for_real_time();

  constexpr double kHeight = 0.02, kOmega = 2 * 3.14159265358979 * 1.5;  // m, rad/s
  long missed = 0;
  timespec due = later(now(), period);
  for (std::size_t k = 0; k < steps; ++k) {
    clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &due, nullptr);
    const timespec begin = now();
    const double phase = kOmega * static_cast<double>(k + 1) * car.settings().step;
    car.set_input(wheel, kHeight * (1 - std::cos(phase)), kHeight * kOmega * std::sin(phase),
                  kHeight * kOmega * kOmega * std::cos(phase));
    if (car.step().status == mbs::StepStatus::factorization_failed)
      throw std::runtime_error("a step failed");
    const timespec end = now();
    waking.push_back(between(due, begin));
    working.push_back(between(begin, end));
    due = later(due, period);
    if (between(due, end) > 0) {  // the next step was due before this one was done: go on from here
      ++missed;
      due = later(end, period);
    }
  }
  std::printf("%s, %zu steps of %ld us\n", car.implementation().c_str(), steps, period / 1000);
  print("from due to awake", waking);
  print("input and step", working);
  std::printf("deadlines missed: %ld\n", missed);
} catch (const std::exception& error) {
  std::fprintf(stderr, "realtime: %s\n", error.what());
  return 1;
}
