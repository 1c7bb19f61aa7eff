// mbs bench: variants over scenes, with the flags and reports of Google Benchmark.
#include "mbs/bench_command.hpp"

#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <cstring>
#include <utility>

#include "bench/batch_rows.hpp"
#include "bench/bench_plan.hpp"
#include "bench/operation_rows.hpp"
#include "bench/reporters.hpp"
#include "bench/scene_timing.hpp"
#include "environment/environment.hpp"
#include "environment/machine.hpp"
#include "mbs/bench_flags.hpp"
#include "mbs/bench_output.hpp"
#include "mbs/commands.hpp"
#include "mbs/file_names.hpp"
#include "mbs/progress.hpp"
#include "mbs/step_bench.hpp"
#include "usage_error.hpp"

namespace mbs {
namespace {

/// What standard output shows, as typed.
struct Shown {
  bool summary = false, rows = false;
};

void add_options(CLI::App& app, BenchRequest& request, StepOptions& step, Shown& shown) {
  app.add_option("scenes", request.scenes, "scenes (default: four-bar:10 four-bar:40)");
  app.add_option("--implementation", request.implementations,
                 "folder or folder/variant, several by commas or repeated (default: all but "
                 "examples and what was tried; without a summary also the control null/null, "
                 "which does nothing); NAME+twin is a second instance of a variant")
      ->allow_extra_args(false)
      ->delimiter(',');
  step.add_to(app);
  app.add_option("--steps", request.steps,
                 "steps of the stretch (default: 800, fewer above 400 variables or to be centred)");
  app.add_option("--start", request.start,
                 "start of the stretch of the four-bar, s (default: centred on the first singular "
                 "position); other scenes start at 0");
  app.add_option("--slower-than", request.slower_than,
                 "leave out whoever takes more than this many times as long as the fastest "
                 "(default: time all)");
  app.add_option("--patience", request.patience,
                 "leave out whose first stretch takes longer than this, s (default: wait)");
  app.add_flag("--summary", shown.summary,
               fmt::format("a short answer soon, for 80 columns: who is fastest, libraries and own "
                           "code apart, who was left out, and why; --slower-than is {:g} times the "
                           "fastest of its layer, --patience {:g} s (default on a terminal)",
                           kSummarySlowerThan, kSummaryPatience));
  app.add_flag("--no-summary", shown.rows,
               "all contenders with set-up times and errors (default elsewhere)");
  app.add_option("--seed", request.seed, "of the order of turns (default: 1)");
  app.add_flag("--phases", request.phases, "also give the share of time of each phase");
  app.add_flag("--operations", request.operations,
               "instead of steps, time Jacobian evaluation, rank-k update and matrix addition, "
               "each by itself, of the variants that offer them");
  app.add_flag(
      "--batch", request.batch,
      "instead of single simulations, time parameter sets in batches, as large as suits the "
      "variant, and alone: step_us and alone_us are of one set, gain is their ratio");
  app.add_option(
      "--sets", request.sets,
      "of --batch: parameter sets, spread evenly over a range of 28 % in masses, of 14 % in "
      "lengths and of 64 % in forces (default: 64)");
}

/// Whether the summary is what to show. Throws UsageError for what does not go together.
bool shows_summary(const Shown& shown, const BenchRequest& request, const BenchFlags& flags) {
  if (shown.summary && shown.rows) {
    throw UsageError("--summary and --no-summary do not go together");
  }
  if (shown.summary && flags.format_given) {
    throw UsageError("--summary and --benchmark_format do not go together");
  }
  if (shown.summary) return true;
  return ::isatty(STDOUT_FILENO) != 0 && !shown.rows && !flags.format_given && flags.out.empty() &&
         !request.operations && !request.batch;
}

/// Operations take the step and the penalty factor, and know nothing else of a step.
void require_no_step_settings(const CLI::App& app) {
  for (const char* name :
       {"--tolerance", "--max-passes", "--scheme", "--multipliers", "--tangent", "--projections",
        "--projections-every", "--precision", "--geometric-stiffness"}) {
    if (app.get_option(name)->count() > 0) {
      throw UsageError(fmt::format("{} is one of steps: it does not go with --operations", name));
    }
  }
}

bool asks_for_help(int argc, char** argv) {
  return std::any_of(argv + 1, argv + argc, [](const char* argument) {
    return std::strcmp(argument, "--help") == 0 || std::strcmp(argument, "-h") == 0;
  });
}

void print_help(const CLI::App& app) {
  fmt::print(
      "{}\nAnd Google Benchmark's flags, over the names folder/variant/scene. Of steps,\n"
      "--benchmark_repetitions is the number of samples of each contender (default: {} to {}, by "
      "what fits\ninto {:g} s a scene), --benchmark_min_time the length of a turn (default: {:g} "
      "s; "
      "0: whole stretches).\nThose for aggregates, random interleaving and warm-up are for "
      "--operations and --batch.\n",
      app.help(), kLeastSamples, kMostSamples, kSceneTime, kSlice);
  std::fflush(stdout);
  benchmark::PrintDefaultHelp();
}

/// Operations and batches, each row on its own.
int run_benchmarks(const std::vector<PlannedCell>& cells, const BenchRequest& request,
                   BenchOutput& output) {
  redirect_benchmark_out(output.path());
  OperationRows operations;
  BatchRows batches;
  if (request.operations) operations.add(cells);
  if (request.batch) batches.add(cells, request.sets.value_or(kSets));
  const auto display =
      request.batch ? make_display_reporter(kBatchCounters) : make_display_reporter({});
  JsonReporter file;
  benchmark::RunSpecifiedBenchmarks(display.get(), output.path().empty() ? nullptr : &file, ".");
  benchmark::ClearRegisteredBenchmarks();
  benchmark::Shutdown();
  output.finish(file.complete());
  bool failed = operations.failed() || batches.failed();
  const PlannedScene* last = nullptr;
  for (const PlannedCell& cell : cells) {
    if (!request.batch || std::exchange(last, cell.scene) == cell.scene) continue;
    if (batches.timed(cell.scene)) continue;
    fmt::print(stderr, "mbs: {}: nothing was timed: no row has a time\n", cell.scene->scene.name);
    failed = true;
  }
  return failed ? 1 : 0;
}

/// What about the settings is likely to spoil the motion, once a scene.
void warn(const std::vector<PlannedCell>& cells, const StepOptions& step) {
  const PlannedScene* last = nullptr;
  for (const PlannedCell& cell : cells) {
    if (std::exchange(last, cell.scene) == cell.scene) continue;
    const std::string& name = last->scene.name;
    show_doing(fmt::format("{}: looking at the settings", name));
    const auto warnings = step.warnings(last->scene.model, last->settings);
    show_doing("");
    print_warnings(name, warnings);
  }
}

int run_cells(const std::vector<PlannedCell>& cells, const BenchRequest& request,
              const BenchFlags& flags, const StepOptions& step) {
  for (const std::string& scene : request.scenes) {
    require_not_scene("--benchmark_out", flags.out, scene);
  }
  BenchOutput output(flags.out);
  stay_on_this_processor();
  for (const auto& [key, value] : environment_record()) benchmark::AddCustomContext(key, value);
  if (!request.operations) warn(cells, step);
  if (request.operations || request.batch) return run_benchmarks(cells, request, output);
  return time_steps(cells, request, flags, output);
}

}  // namespace

int bench_command(int argc, char** argv) {
  BenchRequest request;
  StepOptions step;
  Shown shown;
  request.settings = [&step](const Model& model) { return step.resolve(model); };
  CLI::App app("Times implementations over a stretch of each scene's motion.", "mbs bench");
  add_options(app, request, step, shown);
  refuse_misread(app);
  if (asks_for_help(argc, argv)) {
    print_help(app);
    return 0;
  }
  const BenchFlags flags = take_benchmark_flags(argc, argv);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    throw UsageError(fmt::format("{} (mbs bench --help)", error.what()));
  }
  if (request.operations) require_no_step_settings(app);
  request.summary = shows_summary(shown, request, flags);
  request.watch = show_doing;
  const BenchPlan plan = plan_bench(request);
  show_doing("");
  const std::vector<PlannedCell> cells = filter_cells(plan.cells, flags.filter);
  if (flags.list_tests) {
    for (const PlannedCell& cell : cells) fmt::print("{}\n", cell.name);
    return 0;
  }
  return run_cells(cells, request, flags, step);
}

}  // namespace mbs
