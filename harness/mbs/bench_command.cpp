// mbs bench: Google Benchmark over variants and scenes; its flags are taken along with ours.
#include "mbs/bench_command.hpp"

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "bench/batch_rows.hpp"
#include "bench/bench_plan.hpp"
#include "bench/bench_rows.hpp"
#include "bench/operation_rows.hpp"
#include "bench/reporters.hpp"
#include "environment/environment.hpp"
#include "mbs/commands.hpp"
#include "mbs/file_names.hpp"
#include "usage_error.hpp"

// The library exports all of its flags, but has no header and no accessor for these.
namespace benchmark {
extern std::string FLAGS_benchmark_out;
extern std::string FLAGS_benchmark_out_format;
extern bool FLAGS_benchmark_list_tests;
extern double FLAGS_benchmark_min_time;
extern int32_t FLAGS_benchmark_repetitions;
}  // namespace benchmark

namespace mbs {
namespace {

namespace fs = std::filesystem;

void add_options(CLI::App& app, BenchRequest& request, StepOptions& step) {
  app.add_option("scenes", request.scenes, "scenes (default: four-bar:10 four-bar:40)");
  app.add_option("--implementation", request.implementations,
                 "folder or folder/variant, repeatable (default: all, and the control null/null "
                 "that does nothing)");
  step.add_to(app);
  app.add_option("--steps", request.steps,
                 "steps of the stretch (default: 800, or fewer to be centred)");
  app.add_option("--start", request.start,
                 "start of the stretch, s (default: centred on the first singular position)");
  app.add_flag("--phases", request.phases, "also give the share of time of each phase");
  app.add_flag("--operations", request.operations,
               "instead of steps, time Jacobian evaluation, rank-k update and matrix addition of "
               "the variants that offer them one by one");
  app.add_flag(
      "--batch", request.batch,
      "instead of single simulations, time parameter sets in batches of as many as a variant is "
      "best given, and alone: step_us and alone_us are of one of them, gain is their ratio");
  app.add_option("--sets", request.sets,
                 "of --batch: parameter sets, spread evenly over a range of 28 % in masses and of "
                 "14 % in lengths (default: 64)");
}

bool asks_for_help(int argc, char** argv) {
  return std::any_of(argv + 1, argv + argc, [](const char* argument) {
    return std::strcmp(argument, "--help") == 0 || std::strcmp(argument, "-h") == 0;
  });
}

void print_help(const CLI::App& app) {
  fmt::print("{}\nAnd Google Benchmark's flags, over the names folder/variant/scene:\n",
             app.help());
  std::fflush(stdout);
  benchmark::PrintDefaultHelp();
}

/// Takes Google Benchmark's flags out of argv and refuses values that it would not survive.
void take_benchmark_flags(int& argc, char** argv) {
  benchmark::Initialize(&argc, argv, [] {
    // Help never comes here; for a wrong value the library prints its usage and exits with status
    // 0.
    throw UsageError(
        "--benchmark_format and --benchmark_out_format are one of console, json, csv; "
        "--benchmark_time_unit is one of ns, us, ms, s");
  });
  if (benchmark::FLAGS_benchmark_out_format != "json") {
    throw UsageError(fmt::format("--benchmark_out_format={}: results are written as json only",
                                 benchmark::FLAGS_benchmark_out_format));
  }
  if (!(benchmark::FLAGS_benchmark_min_time >= 0.0 && benchmark::FLAGS_benchmark_min_time < 1e6)) {
    throw UsageError(fmt::format("--benchmark_min_time={}: it must be 0 to 1e6 s",
                                 benchmark::FLAGS_benchmark_min_time));
  }
  if (benchmark::FLAGS_benchmark_repetitions < 1 ||
      benchmark::FLAGS_benchmark_repetitions > 10000) {
    throw UsageError(fmt::format("--benchmark_repetitions={}: it must be 1 to 10000",
                                 benchmark::FLAGS_benchmark_repetitions));
  }
}

/// Makes Google Benchmark write to "<out>.partial", to be renamed when it is complete, so that an
/// interrupted run leaves older results alone. Returns the name to rename to, or "" if there is no
/// file or it is a device. Throws UsageError if nothing can be written there.
std::string redirect_output() {
  std::string& out = benchmark::FLAGS_benchmark_out;
  if (out.empty()) return "";
  const std::string given = out;
  std::error_code error;
  const bool direct = fs::exists(given, error) && !fs::is_regular_file(given, error);
  if (!direct) out += ".partial";
  // Opening it fails the same way in the library, which then leaves by exit().
  if (!std::ofstream(out, std::ios::app)) {
    throw UsageError(
        fmt::format("--benchmark_out={}: cannot be written ({})", given, std::strerror(errno)));
  }
  return direct ? "" : given;
}

int run_cells(const std::vector<PlannedCell>& cells, const BenchRequest& request) {
  for (const std::string& scene : request.scenes) {
    require_not_scene("--benchmark_out", benchmark::FLAGS_benchmark_out, scene);
  }
  const std::string rename_to = redirect_output();
  const std::string out = benchmark::FLAGS_benchmark_out;
  BenchRows rows;
  OperationRows operations;
  BatchRows batches;
  if (request.operations) {
    operations.add(cells);
  } else if (request.batch) {
    batches.add(cells, request.sets.value_or(kSets));
  } else {
    rows.add(cells, request.phases);
  }
  for (const auto& [key, value] : environment_record()) benchmark::AddCustomContext(key, value);
  const auto display =
      request.batch ? make_display_reporter(kBatchCounters) : make_display_reporter(kStepCounters);
  JsonReporter file;
  benchmark::RunSpecifiedBenchmarks(display.get(), out.empty() ? nullptr : &file, ".");
  benchmark::ClearRegisteredBenchmarks();
  benchmark::Shutdown();
  std::error_code error;
  if (!rename_to.empty() && file.complete()) fs::rename(out, rename_to, error);
  if (!out.empty() && (!file.complete() || error)) {
    throw UsageError(fmt::format("--benchmark_out: {} could not be written to its end", out));
  }
  return rows.failed() || operations.failed() || batches.failed() ? 1 : 0;
}

}  // namespace

int bench_command(int argc, char** argv) {
  BenchRequest request;
  StepOptions step;
  request.settings = [&step](const Model& model) { return step.resolve(model); };
  CLI::App app("Times implementations over a stretch of each scene's motion.", "mbs bench");
  add_options(app, request, step);
  refuse_empty(app);
  if (asks_for_help(argc, argv)) {
    print_help(app);
    return 0;
  }
  take_benchmark_flags(argc, argv);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    throw UsageError(fmt::format("{} (mbs bench --help)", error.what()));
  }
  const BenchPlan plan = plan_bench(request);
  const std::vector<PlannedCell> cells = filter_cells(plan.cells, benchmark::GetBenchmarkFilter());
  if (benchmark::FLAGS_benchmark_list_tests) {
    for (const PlannedCell& cell : cells) fmt::print("{}\n", cell.name);
    return 0;
  }
  return run_cells(cells, request);
}

}  // namespace mbs
