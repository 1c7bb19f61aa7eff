// A simulation that does what a test tells it to, and counts.
#pragma once

#include <chrono>
#include <limits>
#include <memory>
#include <vector>

#include "mbs/implementation.hpp"

namespace mbs::test {

using std::chrono::microseconds;
using std::chrono::milliseconds;
using std::chrono::steady_clock;

inline void wait(microseconds time) {
  const auto end = steady_clock::now() + time;
  while (steady_clock::now() < end) {
  }
}

class Scripted final : public Simulation {
 public:
  enum class Script {
    still,
    slow_setup,
    slow,  ///< half a millisecond a step
    not_finite,
    refuses,
    refuses_later,  ///< not before its fourth start and stretch
    throws_number,
    at_limit,
    phases,
    hoards
  };

  Scripted(const Model& model, Script script) : Simulation(model, StepSettings{}), script_(script) {
    ++alive;
    if (script_ == Script::slow_setup) wait(milliseconds(4));
    if (script_ == Script::hoards) hoard_.resize(1'000'000);
  }

  ~Scripted() override { --alive; }

  static inline long steps = 0;   ///< of all objects since a test cleared it
  static inline long starts = 0;  ///< set_state() calls likewise
  static inline int alive = 0;    ///< objects

 protected:
  void do_set_state(const State& state) override {
    ++starts;
    ++own_starts_;
    state_ = state;
    done_ = 0;
    if (script_ == Script::slow_setup) wait(milliseconds(4));
  }
  StepOutcome do_step() override {
    ++steps;
    ++done_;
    if (script_ == Script::not_finite && done_ == 3) {
      state_.v[0] = std::numeric_limits<double>::quiet_NaN();
    }
    if (script_ == Script::slow) wait(microseconds(500));
    if (script_ == Script::throws_number) throw 42;
    const bool late = script_ == Script::refuses_later && own_starts_ > 4;
    if ((script_ == Script::refuses || late) && done_ == 4)
      return {StepStatus::factorization_failed, 1};
    if (script_ == Script::at_limit && done_ % 2 == 0) return {StepStatus::pass_limit, 20};
    if (script_ == Script::phases) {
      phases_.enter(Phase::solve);
      wait(microseconds(60));
      phases_.enter(Phase::projection);
      wait(microseconds(20));
      phases_.enter(Phase::other);
    }
    return {StepStatus::converged, 2};
  }
  void do_get_state(State& state) const override { state = state_; }

 private:
  Script script_;
  State state_;
  std::vector<double> hoard_;
  long done_ = 0, own_starts_ = 0;
};

template <Scripted::Script script>
std::unique_ptr<Simulation> create_scripted(const Model& model, const StepSettings&) {
  return std::make_unique<Scripted>(model, script);
}

}  // namespace mbs::test
