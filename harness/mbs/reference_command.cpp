// mbs reference: what the reference computes in one step, as numbers to compare one's own with.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "ladder/step_rungs.hpp"
#include "ladder/term_models.hpp"
#include "mbs/commands.hpp"
#include "reference/reference_simulation.hpp"
#include "registry/setting_names.hpp"
#include "run/driver_end.hpp"
#include "run/initial_state.hpp"
#include "run/settings.hpp"
#include "scene/row_names.hpp"
#include "scene/scene.hpp"
#include "usage_error.hpp"

namespace mbs {
namespace {

using nlohmann::ordered_json;  // in the order in which a step computes them

struct ReferenceOptions {
  std::string scene;
  StepSettings settings;
  std::string penalty = "auto";
  int after = 0;
  bool moved = false;
};

/// A scene, or a model of the ladder by its name.
Scene scene_or_term(const std::string& name) {
  for (const TermModel& term : term_models()) {
    if (term.name == name) return {term.name, term.model, {}, {}};
  }
  return load_scene(name);
}

/// The rows of a matrix that is stored row by row.
ordered_json rows_of(const std::vector<double>& values, int columns) {
  ordered_json rows = ordered_json::array();
  for (auto row = values.begin(); row != values.end(); row += columns) {
    rows.push_back(std::vector<double>(row, row + columns));
  }
  return rows;
}

ordered_json state_json(const State& state) {
  return {{"t", state.t}, {"q", state.q}, {"v", state.v}, {"a", state.a}, {"lambda", state.lambda}};
}

/// The state after a step from `state`, with what the step said of itself.
ordered_json step_json(const Model& model, const StepSettings& settings, const State& state) {
  ReferenceSimulation simulation(model, settings);
  simulation.set_state(state);
  const StepOutcome outcome = simulation.step();
  State after;
  simulation.get_state(after);
  ordered_json result = state_json(after);
  result["passes"] = outcome.passes;
  result["converged"] = outcome.status == StepStatus::converged;
  return result;
}

ordered_json reference_json(const Scene& scene, const StepSettings& settings,
                            const ReferenceOptions& options) {
  const Model& model = scene.model;
  const int n = model.variables();
  ReferenceSimulation simulation(model, settings);
  State state = initial_state(model);
  simulation.set_state(state);
  for (int step = 1; step <= options.after; ++step) {
    if (simulation.step().status == StepStatus::factorization_failed) {
      throw UsageError(fmt::format("scene '{}': the reference fails in step {}", scene.name, step));
    }
  }
  simulation.get_state(state);
  if (options.moved) state = moved_state(model, state, settings.penalty);

  simulation.set_state(state);
  FirstPass pass;
  if (!simulation.show_first_pass(pass)) throw UsageError("the reference shows no pass");
  ordered_json variables = ordered_json::array(), constraints = ordered_json::array();
  for (int i = 0; i < n; ++i) variables.push_back(variable_name(model, i));
  for (int k = 0; k < model.constraints(); ++k) constraints.push_back(row_name(model, k));

  StepSettings one_pass = settings;
  one_pass.max_passes = 1;
  one_pass.projections = Projections::none;
  ordered_json passed = step_json(model, one_pass, state);
  std::vector<double> delta = passed.at("q").get<std::vector<double>>();
  for (std::size_t i = 0; i < delta.size(); ++i) delta[i] -= pass.q[i];
  passed["Delta_q"] = delta;
  one_pass.projections = Projections::both;
  const ordered_json projected = step_json(model, one_pass, state);
  return {{"scene", scene.name},
          {"step", settings.step},
          {"penalty", settings.penalty},
          {"tolerance", settings.tolerance},
          {"variables", variables},
          {"constraints", constraints},
          {"state", state_json(state)},
          {"predicted", {{"q", pass.q}, {"v", pass.v}, {"a", pass.a}}},
          {"Phi", pass.Phi},
          {"Phi_q", rows_of(pass.Phi_q, n)},
          {"f", pass.f},
          {"T", rows_of(pass.T, n)},
          {"after_one_pass", passed},
          {"projected_after_one_pass", {{"v", projected.at("v")}, {"a", projected.at("a")}}},
          {"after_the_step", step_json(model, settings, state)}};
}

/// A quantity, or a row of a matrix, a line.
void print_json(const ordered_json& object) {
  const char* before = "{";
  for (const auto& [key, value] : object.items()) {
    fmt::print("{}\n  \"{}\": ", before, key);
    before = ",";
    const bool is_matrix = value.is_array() && !value.empty() && value[0].is_array();
    if (!is_matrix) {
      fmt::print("{}", value.dump());
      continue;
    }
    const char* before_row = "[";
    for (const ordered_json& row : value) {
      fmt::print("{}\n    {}", before_row, row.dump());
      before_row = ",";
    }
    fmt::print("]");
  }
  fmt::print("\n}}\n");
}

int print_reference(ReferenceOptions& options) {
  require_step(options.settings.step);
  if (options.after < 0 || options.after > 100'000) {
    throw UsageError(fmt::format("--after is {}: it must be 0 to 100000 steps", options.after));
  }
  const Scene scene = scene_or_term(options.scene);
  constexpr int kMost = 2000;
  if (scene.model.variables() > kMost) {
    throw UsageError(
        fmt::format("scene '{}' has {} variables: matrices are printed in full, of {} at most",
                    scene.name, scene.model.variables(), kMost));
  }
  require_drivers(scene, options.settings.step, options.after + 1);
  StepSettings settings = options.settings;
  settings.penalty = parse_automatic("--penalty", options.penalty);
  print_json(reference_json(scene, chosen(scene.model, settings), options));
  return 0;
}

}  // namespace

void add_reference_command(CLI::App& app, int& status) {
  auto* command = app.add_subcommand(
      "reference",
      "what the reference computes in one step: Phi, Phi_q, f, T, corrections, as JSON");
  const auto options = std::make_shared<ReferenceOptions>();
  command
      ->add_option("scene", options->scene,
                   "the scene, or a term's model by its name in the ladder: 'springs, planar'")
      ->required();
  command->add_option("--step", options->settings.step, "time step, s")->capture_default_str();
  command->add_option("--penalty", options->penalty, "penalty factor alpha, or 'auto'")
      ->capture_default_str();
  command->add_option("--after", options->after, "steps from the start to the state that is shown")
      ->capture_default_str();
  command->add_flag("--moved", options->moved,
                    "move that state off its constraints, as check --ladder does");
  command->callback([options, &status] { status = print_reference(*options); });
}

}  // namespace mbs
