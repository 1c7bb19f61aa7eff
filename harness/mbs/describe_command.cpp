// mbs describe: what a scene requires.
#include <fmt/format.h>

#include <cstdio>

#include "describe/describe.hpp"
#include "describe/recommendation.hpp"
#include "mbs/commands.hpp"
#include "registry/setting_names.hpp"
#include "scene_file/load_scene.hpp"

namespace mbs {

void add_describe_command(CLI::App& app, int& status) {
  struct Options {
    std::string scene;
    StepSettings settings;
    bool json = false;
  };
  auto* command = app.add_subcommand("describe",
                                     "coordinates, constraints, degrees of freedom, terms, fill "
                                     "and elimination of a scene, and what to run it with");
  const auto options = std::make_shared<Options>();
  command->add_option("scene", options->scene, "the scene")->required();
  command
      ->add_option("--step", options->settings.step, "time step that the penalty factor is for, s")
      ->capture_default_str();
  add_precision_option(*command, options->settings.precision);
  command->add_flag("--json", options->json, "machine-readable");
  command->callback([options, &status] {
    require_step(options->settings.step);
    const Scene scene = load_scene(options->scene);
    const nlohmann::json description =
        recommended(describe_json(scene, options->settings), scene, options->settings, true);
    if (options->json) {
      fmt::print("{}\n", description.dump(2));
    } else {
      fmt::print("{}{}", describe_text(description), recommendation_text(description));
    }
    status = 0;
  });
}

}  // namespace mbs
