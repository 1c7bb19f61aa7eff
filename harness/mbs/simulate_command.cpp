// mbs simulate: one scene, one implementation, a typed outcome.
#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <optional>

#include "mbs/commands.hpp"
#include "mbs/trajectory.hpp"
#include "run/run.hpp"
#include "usage_error.hpp"

namespace mbs {
namespace {

struct Options {
  std::string scene;
  std::string implementation;
  StepOptions step;
  double duration = 20.0;
  std::string trajectory;
  long every = 1;
  bool json = false;
};

nlohmann::json finite_or_null(std::optional<double> value) {
  if (!value || !std::isfinite(*value)) return nullptr;
  return *value;
}

nlohmann::json summary_json(const Scene& scene, const NamedVariant& variant,
                            const RunSettings& settings, const RunSummary& summary) {
  const double steps = static_cast<double>(std::max(summary.steps, 1L));
  return {{"scene", scene.name},
          {"implementation", variant.name},
          {"variables", scene.model.variables()},
          {"constraints", scene.model.constraints()},
          {"tangent_nonzeros", tangent_nonzeros(scene.model)},
          {"step", settings.step.step},
          {"duration", settings.duration},
          {"penalty", settings.step.penalty},
          {"tolerance", settings.step.tolerance},
          {"max_passes", settings.step.max_passes},
          {"status", to_string(summary.status)},
          {"status_reason", summary.reason},
          {"failed_at", finite_or_null(summary.failed_at)},
          {"steps", summary.steps},
          {"steps_at_limit", summary.steps_at_limit},
          {"passes_per_step", static_cast<double>(summary.passes) / steps},
          {"position_error_max", finite_or_null(summary.position_error_max)},
          {"energy_drift_max", finite_or_null(summary.energy_drift_max)},
          {"constraint_violation_max", finite_or_null(summary.constraint_violation_max)},
          {"setup_us", summary.setup_us},
          {"step_us",
           {{"median", summary.step_us_median},
            {"p99", summary.step_us_p99},
            {"max", summary.step_us_max}}}};
}

void print_text(const nlohmann::json& json) {
  const auto number = [&json](const char* key, const char* unit) {
    return json[key].is_null() ? std::string("none")
                               : fmt::format("{:.3g}{}", json[key].get<double>(), unit);
  };
  fmt::print("{} on {}\n", json["implementation"].get<std::string>(),
             json["scene"].get<std::string>());
  fmt::print("  status                 {}\n", json["status"].get<std::string>());
  fmt::print("  size                   {} variables, {} constraints, {} non-zeros in the tangent\n",
             json["variables"].get<int>(), json["constraints"].get<int>(),
             json["tangent_nonzeros"].get<long>());
  fmt::print("  settings               step {:g} s, penalty {:.4g}, tolerance {:g} m\n",
             json["step"].get<double>(), json["penalty"].get<double>(),
             json["tolerance"].get<double>());
  fmt::print("  steps                  {}, {:.3f} passes each, {} at the pass limit\n",
             json["steps"].get<long>(), json["passes_per_step"].get<double>(),
             json["steps_at_limit"].get<long>());
  fmt::print("  position error max     {}\n", number("position_error_max", " m"));
  fmt::print("  energy drift max       {}\n", number("energy_drift_max", " of its scale"));
  fmt::print("  constraint violation   {}\n", number("constraint_violation_max", " m^2"));
  fmt::print("  set-up                 {:.1f} us\n", json["setup_us"].get<double>());
  fmt::print("  step                   {:.2f} us median, {:.2f} p99, {:.2f} max\n",
             json["step_us"]["median"].get<double>(), json["step_us"]["p99"].get<double>(),
             json["step_us"]["max"].get<double>());
}

/// Simulated time on a terminal's last line, at most once a per cent.
class Progress {
 public:
  explicit Progress(long steps) : steps_(steps), shown_(::isatty(STDERR_FILENO) != 0) {}
  ~Progress() {
    if (percent_ >= 0) fmt::print(stderr, "\r{:40}\r", "");
  }
  void at(long step, double t) {
    const long percent = 100 * step / steps_;
    if (!shown_ || percent == percent_) return;
    percent_ = percent;
    fmt::print(stderr, "\r{:3} %  t = {:.4g} s", percent, t);
    std::fflush(stderr);
  }

 private:
  long steps_;
  bool shown_;
  long percent_ = -1;
};

int simulate(const Options& options) {
  const std::vector<NamedVariant> variants = select_variants({options.implementation});
  if (variants.size() != 1) {
    throw UsageError(fmt::format("--implementation '{}' has {} variants: name one, folder/variant",
                                 options.implementation, variants.size()));
  }
  if (options.every < 1) {
    throw UsageError(fmt::format("--every is {}: it must be at least 1", options.every));
  }
  const Scene scene = load_scene(options.scene);
  const RunSettings settings{options.step.resolve(scene.model), options.duration};
  const long steps = count_steps(settings);

  std::optional<TrajectoryFile> trajectory;
  if (!options.trajectory.empty()) trajectory.emplace(options.trajectory, scene.model);
  RunSummary summary;
  {
    Progress progress(steps);
    summary =
        run(scene, *variants[0].variant, settings, [&](long step, double t, const State& state) {
          if (trajectory && step % options.every == 0) trajectory->write(t, state);
          progress.at(step, t);
        });
  }
  if (trajectory) trajectory->commit();
  const nlohmann::json json = summary_json(scene, variants[0], settings, summary);
  if (options.json) {
    fmt::print("{}\n", json.dump(2));
  } else {
    print_text(json);
  }
  if (summary.status == RunStatus::ok) return 0;
  fmt::print(stderr, "mbs: {} on {}: {}{}{}\n", variants[0].name, scene.name,
             to_string(summary.status),
             summary.failed_at ? fmt::format(" at t = {:g} s: ", *summary.failed_at) : ": ",
             summary.reason);
  return 1;
}

}  // namespace

void add_simulate_command(CLI::App& app, int& status) {
  auto* command = app.add_subcommand("simulate", "simulate a scene with one implementation");
  const auto options = std::make_shared<Options>();
  command->add_option("scene", options->scene, "the scene")->required();
  command->add_option("--implementation", options->implementation, "folder/variant (see mbs list)")
      ->required();
  options->step.add_to(*command);
  command->add_option("--duration", options->duration, "simulated time, s")->capture_default_str();
  command
      ->add_option("--trajectory", options->trajectory,
                   "write positions and velocities of all points to this CSV file")
      ->check([](const std::string& path) {
        return path.empty() ? std::string("is empty: it must be a file name") : std::string();
      });
  command->add_option("--every", options->every, "write every K-th step only")
      ->capture_default_str();
  command->add_flag("--json", options->json, "print the summary as JSON");
  command->callback([options, &status] { status = simulate(*options); });
}

}  // namespace mbs
