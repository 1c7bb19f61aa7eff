// Times batches and their lanes alone by turns, so that both see the same machine.
#include "bench/batch_rows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <span>

#include "bench/measurement.hpp"
#include "check/varied_lanes.hpp"
#include "registry/factory.hpp"
#include "sweep/lane.hpp"

namespace mbs {
namespace {

constexpr double kRange = 0.28;  // from the least to the largest mass

class BatchMeasurement {
 public:
  /// Throws CellFailure, Unsupported or what the variant throws.
  BatchMeasurement(const PlannedCell& cell, int sets)
      : steps_(cell.scene->stretch.steps),
        sets_(vary_lanes(sets, kRange / (sets - 1), cell.scene->scene.model, cell.scene->settings,
                         cell.scene->stretch.initial)) {
    const std::size_t count = sets_.models.size();
    for (std::size_t k = 0; k < count; ++k) {
      alone_.push_back(create_simulation(*cell.variant, *sets_.models[k], sets_.settings[k]));
    }
    const std::span<const Model* const> models = sets_.pointers;
    const std::span<const StepSettings> settings = sets_.settings;
    const std::size_t lanes = lanes_at_once(*cell.variant);
    for (std::size_t first = 0; first < count; first += lanes) {
      const std::size_t size = std::min(lanes, count - first);
      batches_.push_back(
          create_batch(*cell.variant, models.subspan(first, size), settings.subspan(first, size)));
    }
  }

  /// Of the first batch; the last one may have fewer.
  [[nodiscard]] int lanes() const { return batches_.front()->lanes(); }

  /// Seconds of the steps of all sets.
  double time_together() {
    double seconds = 0.0;
    auto start = sets_.starts.begin();
    for (const auto& batch : batches_) {
      for (int lane = 0; lane < batch->lanes(); ++lane) batch->set_state(lane, *start++);
      outcomes_.resize(static_cast<std::size_t>(batch->lanes()));
      const auto begin = Clock::now();
      for (long step = 1; step <= steps_; ++step) {
        batch->step(outcomes_);
        for (const StepOutcome& outcome : outcomes_) require(outcome, step);
      }
      seconds += seconds_since(begin);
    }
    return seconds;
  }

  double time_alone() {
    double seconds = 0.0;
    for (std::size_t k = 0; k < alone_.size(); ++k) {
      alone_[k]->set_state(sets_.starts[k]);
      const auto begin = Clock::now();
      for (long step = 1; step <= steps_; ++step) require(alone_[k]->step(), step);
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
  VariedLanes sets_;
  std::vector<StepOutcome> outcomes_;
  std::vector<std::unique_ptr<BatchSimulation>> batches_;
  std::vector<std::unique_ptr<Simulation>> alone_;
};

}  // namespace

void BatchRows::add(const std::vector<PlannedCell>& cells, int sets) {
  for (const PlannedCell& cell : cells) {
    benchmark::RegisterBenchmark(
        (cell.name + "/batch").c_str(),
        [this, &cell, sets](benchmark::State& state) { run(cell, sets, state); })
        ->UseManualTime()
        ->Unit(benchmark::kMicrosecond);
  }
}

void BatchRows::run(const PlannedCell& cell, int sets, benchmark::State& state) {
  try {
    if (cell.variant->create_batch == nullptr) {
      throw CellFailure("unsupported: this variant does not advance simulations side by side");
    }
    BatchMeasurement measurement(cell, sets);
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
    const double set_steps =
        static_cast<double>(state.iterations()) * sets * static_cast<double>(planned.stretch.steps);
    state.counters["sets"] = sets;
    state.counters["lanes"] = measurement.lanes();
    state.counters["steps"] = static_cast<double>(planned.stretch.steps);
    state.counters["step_us"] = 1e6 * together / set_steps;
    state.counters["alone_us"] = 1e6 * alone / set_steps;
    state.counters["gain"] = alone / together;
    state.counters["variables"] = planned.scene.model.variables();
    state.counters["constraints"] = planned.scene.model.constraints();
    state.counters["fill_percent"] = planned.fill_percent;
    timed_.insert(&planned);
  } catch (const std::exception&) {
    const std::string why = failure_text();
    // What an implementation does not offer is an answer, as in the gate.
    if (!why.starts_with("unsupported")) failed_ = true;
    state.SkipWithError(why.c_str());
  }
}

}  // namespace mbs
