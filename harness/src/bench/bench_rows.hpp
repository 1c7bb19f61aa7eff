// Turns what was timed into rows for Google Benchmark's reporters.
#pragma once

#include <benchmark/benchmark.h>

#include <array>
#include <vector>

#include "bench/scene_timing.hpp"

namespace mbs {

/// What these rows show people.
inline constexpr std::array kStepCounters{"step_us", "setup_us", "passes", "position_error"};

/// One row for each sample of one contender, with the cell's name: real time and processor time of
/// a stretch in microseconds, `iterations` being the stretches of the sample. All rows that succeed
/// have the same counters, a number that does not exist being NaN: steps, passes, steps_at_limit,
/// step_us, setup_us, memory_bytes, variables, constraints, fill_percent, penalty, step, tolerance,
/// max_passes, start, position_error, constraint_violation, energy_drift and, if phases were asked
/// for, phase_evaluation ... phase_other. A contender that was not timed is a single row with
/// error_occurred and its failure as error_message; if its first steps were seen, with step_us of
/// these.
std::vector<benchmark::BenchmarkReporter::Run> rows_of(const SceneResult& scene,
                                                       const ContenderResult& contender,
                                                       int family);

/// The counters of the phases, in the order of `Phase`.
inline constexpr std::array<const char*, kPhaseCount> kPhaseCounters{
    "phase_evaluation", "phase_assembly",   "phase_factorization",
    "phase_solve",      "phase_projection", "phase_other"};

}  // namespace mbs
