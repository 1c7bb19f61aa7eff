// mbs limit: what a step of the N-four-bar cannot do without, and what the code for it alone takes.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <limits>
#include <nlohmann/json.hpp>

#include "bench/bench_plan.hpp"
#include "environment/environment.hpp"
#include "limit/bounds.hpp"
#include "limit/limit.hpp"
#include "mbs/commands.hpp"
#include "scene_file/load_scene.hpp"

namespace mbs {
namespace {

/// The fastest of nine timed stretches, ns a step: the machine's rates are best ones too.
double measure_step(const MeasurementTask& task) {
  Measurement measurement(task);
  measurement.prepare();
  double best = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 9; ++i) best = std::min(best, measurement.time_stretch());
  measurement.require_finite();
  return 1e9 * best / task.stretch.steps;
}

nlohmann::json row_of(const Scene& scene, const limit::Machine& machine) {
  const int loops = *scene.four_bar_loops;
  const StepSettings settings = StepOptions{}.resolve(scene.model);
  const Stretch stretch = make_stretch(scene, settings.step, default_steps(scene, settings.step));
  const double measured = measure_step({scene, limit::variant(), stretch, settings, false, false});
  const limit::Count count =
      limit::count_steps(loops, settings, stretch.initial, stretch.steps, machine.latencies);
  const limit::Bounds bounds = limit::bounds_of(count, machine);
  const auto a_step = [&](long value) { return static_cast<double>(value) / count.steps; };
  const limit::Operations& done = count.operations;
  return {{"loops", loops},
          {"variables", scene.model.variables()},
          {"steps", count.steps},
          {"passes", a_step(count.passes)},
          {"flops", a_step(done.flops())},
          {"additions", a_step(done.add)},
          {"multiplications", a_step(done.multiply)},
          {"fused", a_step(done.fused)},
          {"divisions", a_step(done.divide)},
          {"comparisons", a_step(done.compare)},
          {"bytes_loaded", a_step(done.loaded)},
          {"bytes_stored", a_step(done.stored)},
          {"working_set", count.bytes},
          {"level", machine.level_of(count.bytes).name},
          {"arithmetic_ns", bounds.arithmetic},
          {"latency_ns", bounds.latency},
          {"memory_ns", bounds.memory},
          {"bound_ns", bounds.least()},
          {"measured_ns", measured},
          {"ratio", measured / bounds.least()}};
}

nlohmann::json machine_json(const limit::Machine& machine) {
  nlohmann::json levels = nlohmann::json::array();
  for (const limit::Level& level : machine.levels) {
    levels.push_back({{"name", level.name}, {"bytes_per_ns", level.bandwidth}});
  }
  return {{"add_ns", machine.latencies.add},
          {"multiply_ns", machine.latencies.multiply},
          {"fused_ns", machine.latencies.fused},
          {"divide_ns", machine.latencies.divide},
          {"vector_bytes", machine.vector_bytes},
          {"flops_per_ns", machine.peak},
          {"divisions_per_ns", machine.divisions},
          {"levels", levels}};
}

void print(const nlohmann::json& machine, const nlohmann::json& rows) {
  const auto get = [](const nlohmann::json& from, const char* key) {
    return from[key].get<double>();
  };
  fmt::print("latency of +, *, fused, / {:.2f}, {:.2f}, {:.2f}, {:.2f} ns; at most {:.1f} flops/ns",
             get(machine, "add_ns"), get(machine, "multiply_ns"), get(machine, "fused_ns"),
             get(machine, "divide_ns"), get(machine, "flops_per_ns"));
  for (const auto& level : machine["levels"]) {
    fmt::print(", {} {:.0f}", level["name"].get<std::string>(), get(level, "bytes_per_ns"));
  }
  fmt::print(
      " bytes/ns\n{:>6} {:>6} {:>6} {:>8} {:>9} {:>9} {:>9} | {:>10} {:>9} {:>9} | {:>9} {:>5}\n",
      "N", "n", "passes", "flops", "divisions", "loaded B", "stored B", "arithmetic", "latency",
      "memory", "measured", "ratio");
  for (const auto& row : rows) {
    fmt::print(
        "{:>6} {:>6} {:>6.2f} {:>8.0f} {:>9.0f} {:>9.0f} {:>9.0f} | {:>10.1f} {:>9.1f} "
        "{:>9.1f} | {:>9.1f} {:>5.2f}\n",
        row["loops"].get<int>(), row["variables"].get<int>(), get(row, "passes"), get(row, "flops"),
        get(row, "divisions"), get(row, "bytes_loaded"), get(row, "bytes_stored"),
        get(row, "arithmetic_ns"), get(row, "latency_ns"), get(row, "memory_ns"),
        get(row, "measured_ns"), get(row, "ratio"));
  }
  fmt::print("All of one step; times in ns, ratio of measured to the largest bound.\n");
}

}  // namespace

void add_limit_command(CLI::App& app, int& status) {
  struct Options {
    std::vector<int> loops{10, 40, 499};
    bool json = false;
  };
  auto* command = app.add_subcommand(
      "limit",
      "lower bounds of a step of the N-four-bar, and the step of code written for it alone");
  const auto options = std::make_shared<Options>();
  command->add_option("N", options->loops, "numbers of loops")->capture_default_str();
  command->add_flag("--json", options->json, "machine-readable");
  command->callback([options, &status] {
    std::vector<Scene> scenes;  // all of them first, so that a bad number loses nothing
    for (const int loops : options->loops) {
      scenes.push_back(load_scene(fmt::format("four-bar:{}", loops)));
    }
    const limit::Machine machine = limit::measure_machine();
    nlohmann::json rows = nlohmann::json::array();
    for (const Scene& scene : scenes) rows.push_back(row_of(scene, machine));
    if (options->json) {
      nlohmann::json context;
      for (const auto& [key, value] : environment_record()) context[key] = value;
      const nlohmann::json all{
          {"context", context}, {"machine", machine_json(machine)}, {"rows", rows}};
      fmt::print("{}\n", all.dump(2));
    } else {
      print(machine_json(machine), rows);
    }
    status = 0;
  });
}

}  // namespace mbs
