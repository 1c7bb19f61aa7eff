// Rows of Google Benchmark for many simulations side by side, against the same ones alone.
#pragma once

#include <benchmark/benchmark.h>

#include <array>
#include <set>
#include <string>
#include <vector>

#include "bench/bench_plan.hpp"

namespace mbs {

/// What rows of batches show people.
inline constexpr std::array kBatchCounters{"sets", "lanes", "step_us", "alone_us", "gain"};

/// Registers "folder/variant/scene/batch": manual time, microseconds, an iteration being one
/// stretch of each set of parameters, as in a what-if study: the sets cover 28 % in masses, 14 % in
/// lengths and 64 % in forces, and as many neighbours as the variant is best given are the lanes of
/// a batch. Counters: sets; lanes of a batch; steps; step_us, the time of a step of one set (that
/// of all over their number); alone_us, the same for a Simulation of each set, one after the other,
/// in the same iterations; gain, alone_us / step_us; variables, constraints and fill_percent. A
/// variant without batches, a lane that is lost, or a batch that is refused is a row with
/// error_occurred and a CellFailure's text as error_message.
class BatchRows {
 public:
  /// `cells` and what they point to must outlive the object, and the object the benchmarks' run.
  void add(const std::vector<PlannedCell>& cells, int sets);
  /// Whether a row that has run failed.
  [[nodiscard]] bool failed() const { return failed_; }
  /// Whether a row of the scene was timed.
  [[nodiscard]] bool timed(const PlannedScene* scene) const { return timed_.contains(scene); }

 private:
  void run(const PlannedCell& cell, int sets, benchmark::State& state);

  bool failed_ = false;
  std::set<const PlannedScene*> timed_;
};

}  // namespace mbs
