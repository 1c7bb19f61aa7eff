// mbs describe: what a scene requires.
#include <fmt/format.h>

#include <cstdio>

#include "mbs/commands.hpp"
#include "scene/describe.hpp"

namespace mbs {

void add_describe_command(CLI::App& app, int& status) {
  struct Options {
    std::string scene;
    bool json = false;
  };
  auto* command = app.add_subcommand(
      "describe", "coordinates, constraints, degrees of freedom and fill of a scene");
  const auto options = std::make_shared<Options>();
  command->add_option("scene", options->scene, "the scene")->required();
  command->add_flag("--json", options->json, "machine-readable");
  command->callback([options, &status] {
    const Scene scene = load_scene(options->scene);
    if (options->json) {
      fmt::print("{}\n", describe_json(scene).dump(2));
    } else {
      fmt::print("{}", describe_text(scene));
    }
    status = 0;
  });
}

}  // namespace mbs
