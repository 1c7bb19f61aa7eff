// How high a car rises from its start if nobody knows its springs well: ./monte_carlo car.json
// [RUNS] [THREADS] [IMPLEMENTATION]
#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <mbs/stepper.hpp>
#include <random>
#include <string>
#include <thread>
#include <vector>

namespace {

struct Task {
  mbs::SceneDocument scene;
  mbs::StepperOptions options;
};

/// The highest that the body gets in two seconds, m, with the springs and dampers of this run.
double highest(const Task& task, unsigned run) {
  mbs::SceneDocument scene = task.scene;
  std::mt19937 random(run);  // of the run, not of the thread: results do not depend on who ran it
  std::normal_distribution<double> factor(1.0, 0.1);
  for (const char* spring : {"FL", "FR", "RL", "RR"}) {
    const std::string path = std::string("springs/spring ") + spring + "/damping";
    scene.set_number(path, scene.number(path) * std::max(0.1, factor(random)));
  }
  mbs::Stepper car(scene, task.options);
  car.set_input(car.input("front stiffness"), 25000.0 * std::max(0.1, factor(random)));
  const int body = car.output("body.z");
  double most = car.outputs()[body];
  for (int step = 0; step < 2000; ++step) {
    if (car.step().status == mbs::StepStatus::factorization_failed) return std::nan("");
    most = std::max(most, car.outputs()[body]);
  }
  return most;
}

/// `text` as a whole number above 0; `what` it is, for messages.
unsigned count(const char* what, const char* text) {
  char* end = nullptr;
  const long value = std::strtol(text, &end, 10);
  if (end != text && *end == '\0' && value > 0 && value <= 1'000'000'000)
    return static_cast<unsigned>(value);
  throw mbs::Refused(std::string(what) + ": found '" + text +
                     "', allowed is a whole number above 0");
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc < 2) throw mbs::Refused("monte_carlo SCENE [RUNS] [THREADS] [IMPLEMENTATION]");
  const auto runs = argc > 2 ? count("RUNS", argv[2]) : 200u;
  const unsigned threads =
      argc > 3 ? count("THREADS", argv[3]) : std::thread::hardware_concurrency();
  Task task{mbs::SceneDocument::load(argv[1]), {.implementation = argc > 4 ? argv[4] : "auto"}};
  task.options.settings.step = 1e-3;
  std::vector<double> results(runs);
  std::atomic<unsigned> next{0};
  std::vector<std::exception_ptr> failures(std::max(1u, threads));
  {
    std::vector<std::jthread> pool;
    for (std::exception_ptr& failure : failures) {
      pool.emplace_back([&] {
        try {
          for (unsigned run = next++; run < runs; run = next++) results[run] = highest(task, run);
        } catch (...) {
          failure = std::current_exception();  // one that leaves a thread ends the program
        }
      });
    }
  }
  for (const std::exception_ptr& failure : failures) {
    if (failure) std::rethrow_exception(failure);
  }
  double mean = 0.0, square = 0.0;
  for (const double result : results) mean += result / runs;
  for (const double result : results) square += (result - mean) * (result - mean) / runs;
  std::printf("%u runs on %u threads: highest body %.5f m on average, standard deviation %.5f m\n",
              runs, threads, mean, std::sqrt(square));
} catch (const std::exception& error) {
  std::fprintf(stderr, "monte_carlo: %s\n", error.what());
  return 1;
}
