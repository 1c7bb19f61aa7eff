// mbs check: the agreement gate over scenes and implementations.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "atomic_file.hpp"
#include "check/gate.hpp"
#include "environment/environment.hpp"
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
  double time_limit = 120.0;
  std::string json;
};

void print_verdict(const Verdict& verdict) {
  fmt::print("{:<24} {:<24} {}{}{}\n", verdict.scene, verdict.implementation, verdict.verdict,
             verdict.reason.empty() ? "" : ": ", verdict.reason);
  for (const Check& check : verdict.checks) {
    const char* mark = !check.passed ? "not run" : *check.passed ? "passed" : "FAILED";
    fmt::print("  {:<18} {:<8} ", check.name, mark);
    if (check.value && check.tolerance) {
      fmt::print("{:.3g} (allowed {:.3g}) ", *check.value, *check.tolerance);
    }
    fmt::print("{}\n", check.detail);
  }
  std::fflush(stdout);
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
  std::vector<Verdict> verdicts;
  std::vector<Scene> scenes;  // all of them before the first check, so that a bad one loses nothing
  for (const std::string& name : options.scenes) scenes.push_back(load_scene(name));
  for (const Scene& scene : scenes) {
    const StepSettings settings = options.step.resolve(scene.model);
    ReferenceRun reference;
    if (why_unsuited(scene.model, settings).empty()) reference = run_reference(scene, settings);
    for (const NamedVariant& variant : variants) {
      verdicts.push_back(check_implementation(scene, variant, settings, reference,
                                              {.seconds = options.time_limit}));
      print_verdict(verdicts.back());
    }
  }
  const auto agreeing = std::ranges::count_if(verdicts, &Verdict::agrees);
  fmt::print("{} of {} agree with the reference\n", agreeing, verdicts.size());
  if (file) {
    nlohmann::json context;
    for (const auto& [key, value] : environment_record()) context[key] = value;
    file->stream() << nlohmann::json{{"context", context}, {"rows", verdicts}}.dump(2) << '\n';
    file->commit();
  }
  const auto acceptable = [](const Verdict& verdict) {
    return verdict.agrees() || verdict.verdict == "unsupported";
  };
  return std::ranges::all_of(verdicts, acceptable) ? 0 : 1;
}

}  // namespace

void add_check_command(CLI::App& app, int& status) {
  auto* command =
      app.add_subcommand("check", "check that implementations agree with the reference");
  const auto options = std::make_shared<CheckOptions>();
  command->add_option("scenes", options->scenes,
                      "scenes (default: four-bar:1 four-bar:10 four-bar:10,fill=0.6 four-bar:40)");
  command->add_option("--implementation", options->implementations,
                      "folder or folder/variant, repeatable (default: all)");
  options->step.add_to(*command);
  command->add_option("--time-limit", options->time_limit, "s a scene and implementation")
      ->capture_default_str();
  command->add_option("--json", options->json, "write the verdicts to this file too");
  command->callback([options, &status] {
    if (options->scenes.empty()) {
      options->scenes = {"four-bar:1", "four-bar:10", "four-bar:10,fill=0.6", "four-bar:40"};
    }
    status = check(*options);
  });
}

}  // namespace mbs
