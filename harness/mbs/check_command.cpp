// mbs check: the agreement gate over scenes and implementations.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <set>

#include "atomic_file.hpp"
#include "check/gate.hpp"
#include "environment/environment.hpp"
#include "ladder/ladder.hpp"
#include "mbs/commands.hpp"
#include "mbs/file_names.hpp"
#include "registry/factory.hpp"
#include "scene/scene.hpp"
#include "scene_file/load_scene.hpp"
#include "usage_error.hpp"

namespace mbs {
namespace {

struct CheckOptions {
  std::vector<std::string> scenes;
  std::vector<std::string> implementations;
  StepOptions step;
  int steps = 800;
  double time_limit = 120.0;
  std::string json;
  bool ladder = false;
};

void print_verdict(const Verdict& verdict) {
  fmt::print("{:<24} {:<24} {}{}{}\n", verdict.scene, verdict.implementation, verdict.verdict,
             verdict.reason.empty() ? "" : ": ", verdict.reason);
  for (const Check& check : verdict.checks) {
    const char* mark = !check.passed   ? (check.value ? "not judged" : "not run")
                       : *check.passed ? "passed"
                                       : "FAILED";
    fmt::print("  {:<18} {:<10} ", check.name, mark);
    if (check.value && check.tolerance) {
      fmt::print("{:.3g} (allowed {:.3g}) ", *check.value, *check.tolerance);
    }
    fmt::print("{}\n", check.detail);
  }
  std::fflush(stdout);
}

void print_rung(const RungReport& report) {
  fmt::print("  {:<11}{}", name_of(report.result), report.rung);
  if (!report.detail.empty()) fmt::print(": {}", report.detail);
  fmt::print("\n");
  if (report.result == RungResult::failed) {
    const Finding& found = report.finding;
    const bool is_close = found.value && found.reference &&
                          std::abs(*found.value - *found.reference) < 1e-7 * std::abs(*found.value);
    const auto text = [&](const std::optional<double>& x) {
      return x ? fmt::format("{:.{}g}", *x, is_close ? 16 : 9) : std::string("not a number");
    };
    if (!found.quantity.empty()) {
      fmt::print("    {}{}{}", found.quantity, found.row.empty() ? "" : ", ", found.row);
      if (!found.row.empty() || found.value) fmt::print(": {}", text(found.value));
      if (found.reference) fmt::print(", the reference has {}", text(found.reference));
      fmt::print("{}{}{}\n", found.detail.empty() ? "" : "; ", found.detail,
                 found.row.starts_with("row ") ? " (the largest difference; rows and columns count from 0)" : "");
    }
    if (!report.equation.empty()) {
      fmt::print("    {}{}\n", report.equation,
                 report.equation.starts_with("paper/") ? "" : " of paper/README.md");
    }
    if (!report.mistakes.empty()) fmt::print("    the usual mistakes:\n");
    for (const std::string& mistake : report.mistakes) fmt::print("    - {}\n", mistake);
    if (!report.command.empty()) fmt::print("    more: build/{}\n", report.command);
  }
  std::fflush(stdout);
}

/// Writes rows to the file of --json.
template <class Row>
void write_rows(AtomicFile& file, const std::vector<Row>& rows) {
  nlohmann::json context;
  for (const auto& [key, value] : environment_record()) context[key] = value;
  file.stream() << nlohmann::json{{"context", context}, {"rows", rows}}.dump(2) << '\n';
  file.commit();
}

int climb_all(const std::vector<NamedVariant>& variants, double seconds,
              std::optional<AtomicFile>& file) {
  std::vector<RungReport> reports;
  bool all_right = true;
  for (const NamedVariant& variant : variants) {
    fmt::print("{}\n", variant.name);
    std::map<RungResult, int> counts;
    std::vector<std::string> not_served;
    std::string why;  // the first was not
    climb(variant, {.seconds = seconds}, [&](const RungReport& report) {
      if (report.result == RungResult::not_served) {
        if (not_served.empty()) why = report.detail;
        not_served.push_back(report.rung);
      } else {
        print_rung(report);
      }
      ++counts[report.result];
      reports.push_back(report);
    });
    const bool failed = counts[RungResult::failed] > 0;
    const bool is_open = counts[RungResult::ok] + counts[RungResult::failed] == 0;
    if (!not_served.empty()) {
      fmt::print("  not served {}{}\n", not_served.front(),
                 not_served.size() > 1 ? fmt::format(" and {} more (--json FILE names all)", not_served.size() - 1) : "");
    }
    fmt::print("{}: {} rungs ok, {} not yet, {} not served\n",
               is_open  ? "nothing was checked"
               : failed ? "stopped at the first rung that failed"
                        : "all that it serves is right",
               counts[RungResult::ok], counts[RungResult::not_yet], not_served.size());
    if (is_open) {
      fmt::print(stderr, "mbs: {}: nothing was checked: it serves no rung ({})\n", variant.name,
                 why);
    } else if (!failed) {
      fmt::print("next: build/mbs check --implementation {}\n", variant.name);
    }
    all_right &= !failed && !is_open;
  }
  if (file) write_rows(*file, reports);
  return all_right ? 0 : 1;
}

/// Adds the verdicts of all `variants` on `scene`.
void check_scene(const CheckOptions& options, const Scene& scene,
                 const std::vector<NamedVariant>& variants, std::vector<Verdict>& verdicts) {
  const StepSettings settings = options.step.resolve(scene.model);
  const auto serves = [&](const NamedVariant& one) {
    return why_not_served(one.variant->serves, scene.model, settings).empty();
  };
  ReferenceRun reference;  // not run for nobody: on a large scene it takes minutes
  if (why_unsuited(scene.model, settings).empty() && std::ranges::any_of(variants, serves)) {
    reference = run_reference(scene, settings, options.steps);
  }
  print_warnings(scene.name, options.step.warnings(scene.model, settings));
  for (const NamedVariant& variant : variants) {
    verdicts.push_back(
        check_implementation(scene, variant, settings, reference, {.seconds = options.time_limit}));
    print_verdict(verdicts.back());
  }
}

int check(const CheckOptions& options) {
  if (!(options.time_limit > 0.0) || !(options.time_limit <= 1e6)) {
    throw UsageError(fmt::format("--time-limit is {:g} s: it must be above 0 and at most 1e6",
                                 options.time_limit));
  }
  const std::vector<NamedVariant> variants = select_variants(options.implementations);
  if (variants.empty()) throw UsageError("no implementation is available (see mbs list)");
  for (const std::string& scene : options.scenes) {
    require_not_scene("--json", options.json, scene);
  }
  std::optional<AtomicFile> file;
  if (!options.json.empty()) file.emplace(options.json);
  if (options.ladder) return climb_all(variants, options.time_limit, file);
  std::vector<Verdict> verdicts;
  std::vector<Scene> scenes;  // all of them before the first check, so that a bad one loses nothing
  for (const std::string& name : options.scenes) scenes.push_back(load_scene(name));
  try {
    for (const Scene& scene : scenes) check_scene(options, scene, variants, verdicts);
  } catch (...) {  // of a later scene: what was judged before is no less true
    if (file && !verdicts.empty()) write_rows(*file, verdicts);
    throw;
  }
  const auto agreeing = std::ranges::count_if(verdicts, &Verdict::agrees);
  const auto unsupported = std::ranges::count(verdicts, "unsupported", &Verdict::verdict);
  const auto served = std::ssize(verdicts) - unsupported;
  fmt::print("{} of {} agree with the reference{}\n", agreeing, served,
             unsupported > 0 ? fmt::format(" (unsupported: {})", unsupported) : "");
  if (file) write_rows(*file, verdicts);
  if (served == 0) {
    fmt::print(stderr, "mbs: nothing was checked: none of these serves that (mbs list: what each does)\n");
    return 1;
  }
  return agreeing == served ? 0 : 1;
}

}  // namespace

void add_check_command(CLI::App& app, int& status) {
  auto* command =
      app.add_subcommand("check", "check that implementations agree with the reference");
  const auto options = std::make_shared<CheckOptions>();
  command->add_option("scenes", options->scenes,
                      "scenes (default: four-bar:1 four-bar:10 four-bar:10,fill=0.6 four-bar:40 "
                      "chain:10 ladder:10)");
  command->add_option("--implementation", options->implementations,
                      "folder or folder/variant, several by commas or repeated (default: all but what "
                      "was tried)")
      ->allow_extra_args(false)
      ->delimiter(',');
  options->step.add_to(*command);
  command
      ->add_option("--steps", options->steps,
                   "steps that are compared, at most; fewer from 500 variables up")
      ->capture_default_str()
      ->check(CLI::Range(16, 800));
  command->add_option("--time-limit", options->time_limit, "s a scene and implementation")
      ->capture_default_str();
  command->add_option("--json", options->json, "write the verdicts to this file too");
  auto* ladder = command->add_flag(
      "--ladder", options->ladder,
      "from the predictor to every term and setting, rung by rung, up to the first that is wrong");
  const std::set<std::string> together{"--help", "--implementation", "--time-limit",
                                       "--json", "--blas",           "--ladder"};
  for (CLI::Option* option : command->get_options()) {
    if (!together.contains(option->get_name())) ladder->excludes(option);
  }
  command->callback([options, &status] {
    if (options->scenes.empty()) {
      options->scenes = {"four-bar:1",  "four-bar:10", "four-bar:10,fill=0.6",
                         "four-bar:40", "chain:10",    "ladder:10"};
    }
    status = check(*options);
  });
}

}  // namespace mbs
