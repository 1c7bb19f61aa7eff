// Runs a cell under Google Benchmark and fills the row's counters.
#include "bench/bench_rows.hpp"

#include <array>
#include <limits>
#include <string_view>

namespace mbs {
namespace {

constexpr std::array<const char*, kPhaseCount> kPhaseCounters{
    "phase_evaluation", "phase_assembly",   "phase_factorization",
    "phase_solve",      "phase_projection", "phase_other"};

void count_settings(const PlannedScene& planned, benchmark::UserCounters& counters) {
  const Model& model = planned.scene.model;
  counters["variables"] = model.variables();
  counters["constraints"] = model.constraints();
  counters["fill_percent"] = planned.fill_percent;
  counters["penalty"] = planned.settings.penalty;
  counters["step"] = planned.settings.step;
  counters["tolerance"] = planned.settings.tolerance;
  counters["max_passes"] = planned.settings.max_passes;
  counters["start"] = planned.stretch.start;
  counters["steps"] = planned.stretch.steps;
  if (planned.scene.fill) counters["fill_seed"] = static_cast<double>(planned.scene.fill->seed);
}

void count_figures(const CellFigures& figures, benchmark::UserCounters& counters) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  counters["passes"] = static_cast<double>(figures.passes);
  counters["steps_at_limit"] = static_cast<double>(figures.steps_at_limit);
  counters["setup_us"] = figures.setup_us;
  counters["memory_bytes"] = figures.memory_bytes;
  counters["position_error"] = figures.position_error.value_or(kNone);
  counters["constraint_violation"] = figures.constraint_violation.value_or(kNone);
  counters["energy_drift"] = figures.energy_drift.value_or(kNone);
  if (!figures.phases) return;
  for (std::size_t i = 0; i < kPhaseCounters.size(); ++i) {
    counters[kPhaseCounters[i]] = (*figures.phases)[i];
  }
}

}  // namespace

void BenchRows::add(const std::vector<PlannedCell>& cells, bool phases) {
  for (const PlannedCell& cell : cells) {
    const PlannedScene& planned = *cell.scene;
    rows_.push_back({cell, Measurement({planned.scene, *cell.variant, planned.stretch,
                                        planned.settings, cell.control, phases})});
    Row& row = rows_.back();
    benchmark::RegisterBenchmark(cell.name.c_str(),
                                 [this, &row](benchmark::State& state) { run(row, state); })
        ->UseManualTime()
        ->Unit(benchmark::kMicrosecond);
  }
}

void BenchRows::run(Row& row, benchmark::State& state) {
  if (live_ != nullptr && live_ != &row) live_->measurement.release();
  live_ = &row;
  try {
    row.measurement.prepare();
    double seconds = 0.0;
    for (auto iteration : state) {
      (void)iteration;
      const double stretch = row.measurement.time_stretch();
      state.SetIterationTime(stretch);
      seconds += stretch;
    }
    row.measurement.require_finite();
    const double steps = static_cast<double>(row.cell.scene->stretch.steps);
    count_settings(*row.cell.scene, state.counters);
    count_figures(row.measurement.figures(), state.counters);
    state.counters["step_us"] = 1e6 * seconds / (static_cast<double>(state.iterations()) * steps);
  } catch (const CellFailure& failure) {
    // What an implementation does not offer is an answer, as in the gate.
    if (!std::string_view(failure.what()).starts_with("unsupported")) failed_ = true;
    state.SkipWithError(failure.what());
  }
}

}  // namespace mbs
