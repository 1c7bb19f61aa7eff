// `mbs bench` without --operations and --batch.
#pragma once

#include <vector>

#include "bench/bench_plan.hpp"
#include "mbs/bench_flags.hpp"
#include "mbs/bench_output.hpp"

namespace mbs {

/// What a summary leaves out unless the user says otherwise: times the fastest of its layer, and s
/// for the first stretch; and where its samples would take longer than so many s, it leaves out
/// more.
inline constexpr double kSummarySlowerThan = 10.0, kSummaryPatience = 5.0, kSummaryBudget = 5.0;

/// Times the cells, scene by scene, and reports as the request and the flags say: summaries,
/// tables, or rows of JSON or CSV, on standard output; rows of JSON in the output file. Returns 1
/// if a contender failed. Throws UsageError if the file cannot be written to its end.
int time_steps(const std::vector<PlannedCell>& cells, const BenchRequest& request,
               const BenchFlags& flags, BenchOutput& output);

}  // namespace mbs
