// Times a batch and its lanes alone by turns, so that both see the same machine.
#include "bench/batch_rows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <memory>

#include "bench/measurement.hpp"
#include "check/varied_lanes.hpp"
#include "run/setting_names.hpp"

namespace mbs {
namespace {

class BatchMeasurement {
 public:
  /// Throws CellFailure, Unsupported or what the variant throws.
  explicit BatchMeasurement(const PlannedCell& cell)
      : steps_(cell.scene->stretch.steps),
        lanes_(vary_lanes(std::max(cell.variant->batch_lanes, 1), cell.scene->scene.model,
                          cell.scene->settings, cell.scene->stretch.initial)),
        outcomes_(static_cast<std::size_t>(lanes_.count())) {
    if (cell.variant->create_batch == nullptr) {
      throw CellFailure("unsupported: this variant does not advance simulations side by side");
    }
    for (std::size_t lane = 0; lane < lanes_.models.size(); ++lane) {
      alone_.push_back(
          create_simulation(*cell.variant, *lanes_.models[lane], lanes_.settings[lane]));
    }
    batch_ = cell.variant->create_batch(lanes_.pointers, lanes_.settings);
  }

  [[nodiscard]] int lanes() const { return lanes_.count(); }

  /// Seconds of the steps of all lanes.
  double time_together() {
    for (int lane = 0; lane < lanes(); ++lane) {
      batch_->set_state(lane, lanes_.starts[static_cast<std::size_t>(lane)]);
    }
    const auto begin = Clock::now();
    for (long step = 1; step <= steps_; ++step) {
      batch_->step(outcomes_);
      for (const StepOutcome& outcome : outcomes_) require(outcome, step);
    }
    return seconds_since(begin);
  }

  double time_alone() {
    double seconds = 0.0;
    for (std::size_t lane = 0; lane < alone_.size(); ++lane) {
      alone_[lane]->set_state(lanes_.starts[lane]);
      const auto begin = Clock::now();
      for (long step = 1; step <= steps_; ++step) require(alone_[lane]->step(), step);
      seconds += seconds_since(begin);
    }
    return seconds;
  }

 private:
  using Clock = std::chrono::steady_clock;

  static double seconds_since(Clock::time_point begin) {
    return std::chrono::duration<double>(Clock::now() - begin).count();
  }

  void require(const StepOutcome& outcome, long step) const {
    if (outcome.status != StepStatus::factorization_failed) return;
    throw CellFailure(fmt::format("factorization-failed: the tangent of step {} of {} was refused",
                                  step, steps_));
  }

  long steps_;
  VariedLanes lanes_;
  std::vector<StepOutcome> outcomes_;
  std::unique_ptr<BatchSimulation> batch_;
  std::vector<std::unique_ptr<Simulation>> alone_;
};

}  // namespace

void BatchRows::add(const std::vector<PlannedCell>& cells) {
  for (const PlannedCell& cell : cells) {
    benchmark::RegisterBenchmark((cell.name + "/batch").c_str(),
                                 [this, &cell](benchmark::State& state) { run(cell, state); })
        ->UseManualTime()
        ->Unit(benchmark::kMicrosecond);
  }
}

void BatchRows::run(const PlannedCell& cell, benchmark::State& state) {
  try {
    BatchMeasurement measurement(cell);
    measurement.time_together();
    measurement.time_alone();
    double together = 0.0, alone = 0.0;
    for (auto iteration : state) {
      (void)iteration;
      const double seconds = measurement.time_together();
      state.SetIterationTime(seconds);
      together += seconds;
      alone += measurement.time_alone();
    }
    const PlannedScene& planned = *cell.scene;
    const double lane_steps = static_cast<double>(state.iterations()) * measurement.lanes() *
                              static_cast<double>(planned.stretch.steps);
    state.counters["lanes"] = measurement.lanes();
    state.counters["steps"] = static_cast<double>(planned.stretch.steps);
    state.counters["step_us"] = 1e6 * together / lane_steps;
    state.counters["alone_us"] = 1e6 * alone / lane_steps;
    state.counters["gain"] = alone / together;
    state.counters["variables"] = planned.scene.model.variables();
    state.counters["constraints"] = planned.scene.model.constraints();
    state.counters["fill_percent"] = planned.fill_percent;
  } catch (const std::exception&) {
    const std::string why = failure_text();
    // What an implementation does not offer is an answer, as in the gate.
    if (!why.starts_with("unsupported")) failed_ = true;
    state.SkipWithError(why.c_str());
  }
}

}  // namespace mbs
