// mbs describe: what a scene requires.
#include <fmt/format.h>

#include <cstdio>

#include "describe/describe.hpp"
#include "mbs/commands.hpp"
#include "scene_file/load_scene.hpp"

namespace mbs {

void add_describe_command(CLI::App& app, int& status) {
  struct Options {
    std::string scene;
    StepSettings settings;
    bool json = false;
  };
  auto* command = app.add_subcommand(
      "describe", "coordinates, constraints, degrees of freedom, terms and fill of a scene");
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
    if (options->json) {
      fmt::print("{}\n", describe_json(scene, options->settings).dump(2));
    } else {
      fmt::print("{}", describe_text(scene, options->settings));
    }
    status = 0;
  });
}

}  // namespace mbs
