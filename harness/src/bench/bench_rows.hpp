// Turns planned cells into rows of Google Benchmark.
#pragma once

#include <benchmark/benchmark.h>

#include <array>
#include <deque>
#include <vector>

#include "bench/bench_plan.hpp"
#include "bench/measurement.hpp"

namespace mbs {

/// What these rows show people.
inline constexpr std::array kStepCounters{"step_us", "setup_us", "passes", "position_error"};

/// Registers one benchmark a cell, with the cell's name, manual time and microseconds: an iteration
/// is one stretch. Every row that succeeds has the same counters, a number that does not exist
/// being NaN: steps, passes, steps_at_limit, step_us, setup_us, memory_bytes, variables,
/// constraints, fill_percent, penalty, step, tolerance, max_passes, start, position_error,
/// constraint_violation, energy_drift and, if phases are asked for, phase_evaluation ...
/// phase_other. A cell that cannot be timed is a row with error_occurred and the CellFailure as
/// error_message.
///
/// Only the simulation of the row that runs is alive, so that big cells do not add up in memory.
class BenchRows {
 public:
  /// `cells` and what they point to must outlive the object, and the object the benchmarks' run.
  void add(const std::vector<PlannedCell>& cells, bool phases);
  /// Whether a row that has run failed.
  [[nodiscard]] bool failed() const { return failed_; }

 private:
  struct Row {
    PlannedCell cell;
    Measurement measurement;
  };
  void run(Row& row, benchmark::State& state);

  std::deque<Row> rows_;
  Row* live_ = nullptr;
  bool failed_ = false;
};

}  // namespace mbs
