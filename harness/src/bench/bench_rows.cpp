// Fills counters.
#include "bench/bench_rows.hpp"

#include <algorithm>
#include <limits>

namespace mbs {
namespace {

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

std::vector<benchmark::BenchmarkReporter::Run> rows_of(const SceneResult& scene,
                                                       const ContenderResult& contender,
                                                       int family) {
  benchmark::BenchmarkReporter::Run common;
  common.run_name.function_name = contender.cell->name;
  common.family_index = family;
  common.per_family_instance_index = 0;
  common.repetition_index = 0;
  common.repetitions = std::max(1, scene.samples);
  common.time_unit = benchmark::kMicrosecond;
  common.statistics = nullptr;
  if (!contender.timed()) {
    common.error_occurred = true;
    common.error_message = contender.failure;
    common.iterations = 0;
    if (contender.look_seconds) common.counters["step_us"] = 1e6 * *contender.look_seconds;
    return {common};
  }
  count_settings(*scene.scene, common.counters);
  count_figures(contender.figures, common.counters);
  const double steps = scene.scene->stretch.steps;
  std::vector<benchmark::BenchmarkReporter::Run> rows;
  for (const Sample& sample : contender.samples) {
    rows.push_back(common);
    rows.back().repetition_index = static_cast<int64_t>(rows.size()) - 1;
    rows.back().iterations = sample.stretches;
    rows.back().real_accumulated_time = sample.spent.seconds;
    rows.back().cpu_accumulated_time = sample.spent.cpu_seconds;
    rows.back().counters["step_us"] =
        1e6 * sample.spent.seconds / static_cast<double>(sample.stretches) / steps;
  }
  return rows;
}

}  // namespace mbs
