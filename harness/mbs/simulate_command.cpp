// mbs simulate: one scene, one implementation, a typed outcome.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <optional>

#include "describe/warnings.hpp"
#include "mbs/commands.hpp"
#include "mbs/file_names.hpp"
#include "mbs/progress.hpp"
#include "mbs/simulate_summary.hpp"
#include "mbs/trajectory.hpp"
#include "run/run.hpp"
#include "run/scaled_equations.hpp"
#include "scene_file/load_scene.hpp"
#include "usage_error.hpp"

namespace mbs {
namespace {

struct SimulateOptions {
  std::string scene;
  std::string implementation;
  StepOptions step;
  double duration = 20.0;
  std::string trajectory;
  std::string output;
  long every = 1;
  std::optional<int> judge_every;
  bool half_step = false;
  bool scale_equations = false;
  std::optional<double> deadline_us;
  int repeats = 1;
  bool json = false;
};

/// Runs, and writes the files that were asked for.
RunSummary run_with_files(const SimulateOptions& options, const Scene& scene,
                          const Variant& variant, const RunSettings& settings) {
  std::optional<TrajectoryFile> trajectory;
  if (!options.trajectory.empty()) trajectory.emplace(options.trajectory, scene);
  std::optional<OutputFile> output;
  if (!options.output.empty()) output.emplace(options.output, scene);
  RunSummary summary;
  {
    Progress progress(settings.duration, "s");
    Observer observer;  // none where nothing is written: states would be copied out for it
    if (trajectory || output) {
      observer = [&](long step, double t, const State& state) {
        const bool wanted = step % options.every == 0;
        if (trajectory && wanted) trajectory->write(t, state);
        if (output) output->follow(t, state, wanted);
      };
    }
    summary = run(scene, variant, settings, observer, [&](double t) { progress.at(t); });
  }
  if (summary.status == RunStatus::unsupported) return summary;  // files that are there stay
  if (trajectory) trajectory->commit();
  if (output) output->commit();
  return summary;
}

void require_files(const SimulateOptions& options) {
  require_not_scene("--output", options.output, options.scene);
  require_not_scene("--trajectory", options.trajectory, options.scene);
  if (options.output.empty() && options.trajectory.empty() && options.every != 1) {
    throw UsageError("--every is for --output and --trajectory, and neither is there");
  }
  if (options.output.empty() || options.trajectory.empty()) return;
  if (is_same_file(options.output, options.trajectory)) {
    throw UsageError("--output and --trajectory name the same file");
  }
}

void add_judging_warning(const Scene& scene, const RunSettings& settings,
                         std::vector<std::string>& warnings) {
  constexpr long kFew = 16;
  const long steps = count_steps(settings),
             judged = (steps - 1) / judge_interval(scene, settings) + 1;
  if (judged >= std::min(kFew, steps)) return;
  warnings.push_back(
      fmt::format("--judge-every {} judges {} of {} steps: what is lost between them is not seen",
                  judge_interval(scene, settings), judged, steps));
}

int simulate(const SimulateOptions& options) {
  const NamedVariant variant = select_variant(options.implementation);
  if (options.every < 1) {
    throw UsageError(fmt::format("--every is {}: it must be at least 1", options.every));
  }
  require_files(options);
  const Scene scene = load_scene(options.scene);
  if (options.half_step && options.scale_equations) {
    throw UsageError("--half-step and --scale-equations do not go together");
  }
  std::optional<ScaledEquations> scaled;
  if (options.scale_equations) scaled.emplace(scene.model);
  const Model& model = scaled ? scaled->model() : scene.model;
  const StepSettings step = options.step.resolve(model);
  RunSettings settings{step,           options.duration,        options.judge_every,
                       std::nullopt,   options.scale_equations, options.deadline_us,
                       options.repeats};
  if (options.half_step) {
    StepOptions half = options.step;
    half.settings.step /= 2;
    settings.half_step = half.resolve(scene.model);
  }
  require_duration(scene, settings);
  std::vector<std::string> warnings = options.step.warnings(model, settings.step);
  add_judging_warning(scene, settings, warnings);
  const std::string open = force_warning(scene);
  if (!open.empty()) warnings.push_back(open);
  const RunSummary summary = run_with_files(options, scene, *variant.variant, settings);
  nlohmann::json json = summary_json(scene, variant, settings, summary);
  json["warnings"] = warnings;
  if (options.json) {
    fmt::print("{}\n", json.dump(2));
  } else {
    fmt::print("{}", summary_text(json, summary));
  }
  const auto when = [&summary](const char* word) {
    return summary.failed_at ? fmt::format(" {} t = {:g} s", word, *summary.failed_at) : "";
  };
  if (summary.status == RunStatus::degraded) {
    fmt::print(stderr, "mbs: degraded{}: {}\n", when("by"), summary.reason);
  }
  if (is_finished(summary.status)) {
    for (const std::string& warning : warnings) fmt::print(stderr, "mbs: warning: {}\n", warning);
    return 0;
  }
  std::vector<std::string> hints = warnings;
  if (hints.empty() && summary.status == RunStatus::diverged) {
    hints.emplace_back("a shorter --step may help");
  }
  fmt::print(stderr, "mbs: {} on {}: {}{}: {}{}\n", variant.name, scene.name,
             to_string(summary.status), when("at"), summary.reason,
             hints.empty() ? "" : fmt::format(" ({})", fmt::join(hints, "; ")));
  return 1;
}

}  // namespace

void add_simulate_command(CLI::App& app, int& status) {
  auto* command = app.add_subcommand("simulate", "simulate a scene with one implementation");
  const auto options = std::make_shared<SimulateOptions>();
  command->add_option("scene", options->scene, "the scene")->required();
  command->add_option("--implementation", options->implementation, "folder/variant (see mbs list)")
      ->required();
  options->step.add_to(*command);
  command->add_option("--duration", options->duration, "simulated time, s, rounded to whole steps")
      ->capture_default_str();
  command->add_option("--trajectory", options->trajectory,
                      "write all points, energies and the constraint violation to this CSV file, "
                      "compressed if it ends in .gz");
  command->add_option(
      "--output", options->output,
      "write the scene's \"outputs\", and nothing else, to this CSV file, compressed if "
      "it ends in .gz");
  command->add_option("--every", options->every, "write every K-th step only, K >= 1")
      ->capture_default_str();
  command->add_option(
      "--judge-every", options->judge_every,
      "judge the state after every K-th step and the last, K >= 1 (default: 64 to 128, or 256 "
      "of the four-bar, fewer in short runs)");
  command->add_flag("--half-step", options->half_step,
                    "also simulate with half the step, and estimate the error by the difference");
  command->add_flag("--scale-equations", options->scale_equations,
                    "multiply constraints by powers of two that make them weigh alike");
  command->add_option("--deadline-us", options->deadline_us,
                      "count the steps that take longer, in microseconds");
  command
      ->add_option("--repeats", options->repeats,
                   "run the same motion R times. The summary then also has times in which every "
                   "step counts with the least of its R: interruptions hardly reach these")
      ->capture_default_str();
  command->add_flag("--json", options->json, "print the summary as JSON");
  command->callback([options, &status] { status = simulate(*options); });
}

}  // namespace mbs
