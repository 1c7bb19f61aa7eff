// mbs sweep: one scene with many parameter sets, a typed outcome each; mbs merge-sweep: its parts.
#include <cstdint>
#include <limits>
#include <memory>

#include "mbs/commands.hpp"
#include "mbs/sweep_options.hpp"
#include "mbs/sweep_parts.hpp"
#include "sweep/job_pool.hpp"
#include "sweep/value_range.hpp"

namespace mbs {
namespace {

constexpr const char* kVary =
    "a number of the scene and its values. May be repeated: all combinations are run, and the last "
    "PATH varies fastest. PATH is the name of a parameter, or keys with items by name or index: "
    "springs/s/stiffness, points/B/velocity/0, gravity/1 (in names ~1 stands for /). RANGE is "
    "a:b:K (K values from a to b), a:b:K:log or v1,v2,...; with --sample also uniform:a:b or "
    "normal:mean:deviation";

}  // namespace

void add_sweep_command(CLI::App& app, int& status) {
  auto* command =
      app.add_subcommand("sweep", "simulate a scene with many parameter sets, for what-if studies");
  const auto options = std::make_shared<SweepOptions>();
  command->add_option("scene", options->scene, "the scene")->required();
  command->add_option("--vary", options->vary, kVary)
      ->required()
      ->allow_extra_args(false)
      ->type_name("PATH=RANGE");
  command->add_option("--implementation", options->implementation, "folder/variant (see mbs list)")
      ->required();
  options->step.add_to(*command);
  command->add_option("--duration", options->duration, "simulated time, s, rounded to whole steps")
      ->capture_default_str();
  command->add_flag("--half-step", options->half_step,
                    "also simulate with half the step, and estimate the error by the difference");
  CLI::Option* sample =
      command
          ->add_option("--sample", options->sampling.count,
                       "draw N sets of all numbers whose RANGE is a distribution. The other numbers "
                       "make a grid, and each of its points gets these N sets")
          ->check(CLI::Range(1L, kMostLanes));
  command->add_option("--seed", options->sampling.seed, "of the random numbers of --sample")
      ->capture_default_str()
      ->check(CLI::Range(std::int64_t{0}, std::numeric_limits<std::int64_t>::max() - 1))
      ->needs(sample);
  command
      ->add_flag("--sobol", options->sampling.sobol,
                 "sample by a Sobol sequence, shifted by the seed, instead of at random")
      ->needs(sample);
  std::vector<CLI::Option*> apart;  // what the rows do not depend on
  apart.push_back(command
                      ->add_option("--jobs", options->jobs, "processes that run lanes side by side")
                      ->check(CLI::Range(1, kMostJobs))
                      ->capture_default_str());
  apart.push_back(command
                      ->add_option("--shard", options->shard,
                                   "only the i-th of K parts, for mbs merge-sweep")
                      ->type_name("i/K"));
  apart.push_back(command->add_flag("--resume", options->resume,
                                    "go on where the same sweep was ended (OUTPUT.journal)"));
  apart.push_back(
      command->add_flag("--check", options->check,
                        "only look whether a lane has values that are refused: runs and "
                        "writes nothing, and needs no --output"));
  apart.push_back(command->add_option("--output", options->output,
                                      "CSV file, compressed if it ends in .gz: a row a lane, with "
                                      "its values, outcome, figures, and last, least and "
                                      "largest value of each of the scene's \"outputs\""));
  for (CLI::Option* option : apart) option->configurable(false);
  command->callback([options, command, &status] {
    if (!options->check && options->output.empty()) throw CLI::RequiredError("--output");
    options->identity = command->config_to_str(/*default_also=*/true);
    status = sweep(*options);
  });
}

void add_merge_sweep_command(CLI::App& app, int& status) {
  auto* command = app.add_subcommand("merge-sweep", "one table of the parts of mbs sweep --shard");
  const auto parts = std::make_shared<std::vector<std::string>>();
  const auto output = std::make_shared<std::string>();
  command->add_option("parts", *parts, "all parts, in any order")->required();
  command->add_option("--output", *output, "the table, as of mbs sweep")->required();
  command->callback([parts, output, &status] { status = merge_sweep(*parts, *output); });
}

}  // namespace mbs
