// What an engine's program provides: a model of a mechanism that can be advanced and read.
#pragma once  // C++17, as Simbody's headers do not compile as C++20

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "mechanism.hpp"

namespace engines {

constexpr double kJudged = 1e-2;  // s: errors are evaluated at these times, as study/accuracy does
constexpr int kJudgedOfScene = 300;  // times that the points of a scene are read

/// What a user can mend: a line, and exit status 2.
struct UsageError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The --setting options, with what was taken of them.
class Settings {
 public:
  explicit Settings(const std::vector<std::string>& words);

  /// The value of `key`, or `usual`. UsageError if it is not a finite number above 0.
  double positive(const std::string& key, double usual);
  /// The value of `key`, or `usual`. UsageError if it is not a finite number of at least 0.
  double number(const std::string& key, double usual);
  /// The place of the value of `key` in `choices`, of which the first is usual.
  std::size_t choice(const std::string& key, const std::vector<std::string>& choices);
  /// UsageError if a setting was not asked for: it means nothing to the engine.
  void require_all_taken() const;

 private:
  std::map<std::string, std::string> values_;
  std::map<std::string, bool> taken_;
};

class Engine {
 public:
  virtual ~Engine() = default;
  /// Advances to the next time at which the state is to be judged, at most to `end`; returns that
  /// time.
  virtual double advance(double end) = 0;
  /// Writes the state of every rod.
  virtual void read(std::vector<RodState>& states) const = 0;
  /// Writes x and y of the points that a scene's outputs name; of engines that take scenes.
  virtual void read_points(std::vector<double>&) const {}
};

/// An engine that takes steps of one length.
class FixedStepEngine : public Engine {
 public:
  explicit FixedStepEngine(Settings& settings) : step_(settings.positive("step", 1e-3)) {}

  double advance(double end) final {
    const long last = std::lround(end / step_);
    const long until = std::min(done_ + std::max(1L, std::lround(kJudged / step_)), last);
    for (; done_ < until; ++done_) do_step();
    return done_ == last ? end : static_cast<double>(done_) * step_;
  }

 protected:
  virtual void do_step() = 0;
  [[nodiscard]] double step() const { return step_; }

 private:
  double step_;
  long done_ = 0;
};

/// Notes what an engine complains about while it runs: the first complaint and their number are
/// reported.
void note_complaint(const std::string& text);

struct Program {
  std::string engine, version;
  std::unique_ptr<Engine> (*create)(const Mechanism&, Settings&, double duration);
  bool takes_scenes = false;  ///< any scene of the harness: it solves our equations
};

/// The whole of an engine's main().
int run_program(const Program& program, int argc, char** argv);

}  // namespace engines
