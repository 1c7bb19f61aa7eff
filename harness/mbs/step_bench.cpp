// Hands each scene to the reporters as soon as it is timed.
#include "mbs/step_bench.hpp"

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>
#include <memory>

#include "bench/bench_rows.hpp"
#include "bench/reporters.hpp"
#include "bench/scene_summary.hpp"
#include "bench/scene_table.hpp"
#include "bench/scene_timing.hpp"
#include "bench/suspect.hpp"
#include "environment/environment.hpp"
#include "mbs/progress.hpp"

namespace mbs {
namespace {

/// What was timed where, in a line.
std::string origin() {
  std::map<std::string, std::string> record;
  for (const auto& [key, value] : environment_record()) record[key] = value;
  return fmt::format("{} build by {} on {}, BLAS {}", record["build_type"], record["compiler"],
                     record["cpu_model"], record["blas"]);
}

/// Processes that want to run, the mean over the last minute; -1: the system does not tell.
double machine_load() {
  double load = -1.0;
  return ::getloadavg(&load, 1) == 1 ? load : -1.0;
}

/// Why nobody but the control was timed, or left out as slow; empty if somebody was, or if nobody
/// else was asked for.
std::string why_nobody(const SceneResult& scene) {
  std::string first;
  long others = -1;
  for (const ContenderResult& one : scene.contenders) {
    if (one.cell->control) continue;
    if (one.timed() || one.slower()) return "";
    if (others++ < 0) first = fmt::format("{}: {}", one.cell->variant_name(), one.failure);
  }
  return others > 0 ? fmt::format("{}; and {} more", first, others) : first;
}

/// Where the rows of scenes go, while the run goes on.
class StepReport {
 public:
  StepReport(const BenchRequest& request, const BenchFlags& flags, const std::string& path)
      : path_(path), summary_(request.summary), everyone_(request.implementations.empty()) {
    if (flags.format != "console") display_ = make_display_reporter(kStepCounters);
    if (!display_) fmt::print("{}\n", summary_ ? filled(origin()) : origin() + "\n");
    if (!path.empty()) stream_.open(path, std::ios::app);
    file_.SetOutputStream(&stream_);
    const benchmark::BenchmarkReporter::Context context;
    if (display_) display_->ReportContext(context);
    if (!path.empty()) file_.ReportContext(context);
  }

  void add(const SceneResult& scene) {
    for (const ContenderResult& contender : scene.contenders) {
      const auto rows = rows_of(scene, contender, families_++);
      if (display_) display_->ReportRuns(rows);
      if (!path_.empty()) file_.ReportRuns(rows);
      failed_ = failed_ || contender.failed();
    }
    if (!display_) {
      fmt::print("{}", summary_ ? scene_summary(scene, machine_load()) : scene_table(scene));
    }
    std::fflush(stdout);
    if (const std::string why = why_nobody(scene); !why.empty()) {
      fmt::print(stderr, "mbs: {}: nothing was timed: {}\n", scene.scene->scene.name, why);
      failed_ = true;
    }
  }

  /// Whether the file is complete.
  bool finish() {
    if (!display_ && summary_) {
      fmt::print("{}{}", everyone_ ? unavailable_summary() : "", summary_footer());
    } else if (!display_) {
      fmt::print("{}", table_footer());
    }
    if (display_) display_->Finalize();
    if (!path_.empty()) file_.Finalize();
    return path_.empty() || file_.complete();
  }

  [[nodiscard]] bool failed() const { return failed_; }

 private:
  std::string path_;
  bool summary_, everyone_;
  std::unique_ptr<benchmark::BenchmarkReporter> display_;  ///< none for tables and summaries
  std::ofstream stream_;
  JsonReporter file_;
  int families_ = 0;
  bool failed_ = false;
};

TimingWishes wishes_of(const BenchRequest& request, const BenchFlags& flags) {
  TimingWishes wishes;
  wishes.slice = flags.min_time.value_or(wishes.slice);
  wishes.samples = flags.repetitions.value_or(0);
  if (request.seed) wishes.seed = static_cast<std::uint64_t>(*request.seed);
  wishes.slower_than = request.slower_than;
  wishes.patience = request.patience;
  wishes.phases = request.phases;
  if (!request.summary) return wishes;
  wishes.by_layer = true;
  wishes.slower_than = request.slower_than.value_or(kSummarySlowerThan);
  if (!request.slower_than) wishes.budget = kSummaryBudget;
  wishes.patience = request.patience.value_or(kSummaryPatience);
  return wishes;
}

}  // namespace

int time_steps(const std::vector<PlannedCell>& cells, const BenchRequest& request,
               const BenchFlags& flags, BenchOutput& output) {
  const TimingWishes wishes = wishes_of(request, flags);
  benchmark::AddCustomContext("seed", std::to_string(wishes.seed));
  benchmark::AddCustomContext("slice_seconds", fmt::format("{:g}", wishes.slice));
  StepReport report(request, flags, output.path());
  const SuspectWatch suspects;
  for (auto begin = cells.begin(); begin != cells.end();) {
    const auto end = std::find_if(
        begin, cells.end(), [&](const PlannedCell& cell) { return cell.scene != begin->scene; });
    const SceneResult scene = time_scene({begin, end}, wishes, show_doing);
    show_doing("");
    report.add(scene);
    begin = end;
  }
  output.finish(report.finish());
  return report.failed() ? 1 : 0;
}

}  // namespace mbs
