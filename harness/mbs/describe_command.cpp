// mbs describe: what a scene requires.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

#include "describe/describe.hpp"
#include "describe/recommendation.hpp"
#include "mbs/commands.hpp"
#include "registry/factory.hpp"
#include "registry/registry.hpp"
#include "scene_file/load_scene.hpp"

namespace mbs {
namespace {

/// Whether the variants of this build serve the scene.
WhyNot why_not(const Model& model, StepSettings settings) {
  return [&model, settings](const std::string& name, Scheme scheme) mutable -> std::string {
    const auto variants = all_variants();
    const auto found = std::ranges::find(variants, name, &NamedVariant::name);
    if (found == variants.end()) return "it is not in this build";
    settings.scheme = scheme;
    const Serves& serves = found->variant->serves;
    std::string missing = why_not_served(serves, settings);
    if (missing.empty()) missing = why_not_served(serves.terms, model);
    return missing.empty() ? "" : "it does not serve " + missing;
  };
}

}  // namespace

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
    nlohmann::json description = describe_json(scene, options->settings);
    description.update(recommendation_json(parse_rule(kRuleText), description,
                                           why_not(scene.model, options->settings)));
    if (options->json) {
      fmt::print("{}\n", description.dump(2));
    } else {
      fmt::print("{}{}", describe_text(description), recommendation_text(description));
    }
    status = 0;
  });
}

}  // namespace mbs
