// From the command line's wishes to cells.
#include "bench/bench_plan.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include "bench/null_variant.hpp"
#include "exact/four_bar_exact.hpp"
#include "regular_expression.hpp"
#include "scene_file/load_scene.hpp"
#include "usage_error.hpp"

namespace mbs {
namespace {

constexpr const char* kControl = "null/null";
/// A second instance of a variant: what the measurement tells apart where nothing differs (A/A).
constexpr std::string_view kTwin = "+twin";

void check(const BenchRequest& request) {
  constexpr int kMostSteps = 10'000'000;
  if (request.steps && (*request.steps < 1 || *request.steps > kMostSteps)) {
    throw UsageError(fmt::format("--steps is {}: it must be 1 to {}", *request.steps, kMostSteps));
  }
  if (request.batch && (request.operations || request.phases)) {
    throw UsageError("--batch goes with neither --operations nor --phases");
  }
  if (request.operations && request.phases) {
    throw UsageError("--phases are those of steps: they do not go with --operations");
  }
  if (request.operations && (request.steps || request.start)) {
    throw UsageError("--steps and --start are those of steps: they do not go with --operations");
  }
  if (request.summary && (request.batch || request.operations)) {
    throw UsageError("--summary is one of steps: it goes with neither --batch nor --operations");
  }
  constexpr int kMostSets = 4096;
  if (request.sets && !request.batch) throw UsageError("--sets goes with --batch");
  if (request.sets && (*request.sets < 2 || *request.sets > kMostSets)) {
    throw UsageError(fmt::format("--sets is {}: it must be 2 to {}", *request.sets, kMostSets));
  }
  constexpr double kLatestStart = 1e6;  // s; later, the elliptic functions' argument loses digits
  if (request.start && !(*request.start >= 0.0 && *request.start <= kLatestStart)) {
    throw UsageError(
        fmt::format("--start is {:g} s: it must be 0 to {:g} s", *request.start, kLatestStart));
  }
}

void check_timing(const BenchRequest& request) {
  if (request.operations || request.batch) {
    for (const auto& [name, given] : {std::pair("--seed", request.seed.has_value()),
                                      std::pair("--slower-than", request.slower_than.has_value()),
                                      std::pair("--patience", request.patience.has_value())}) {
      if (given)
        throw UsageError(fmt::format("{} goes with neither --batch nor --operations", name));
    }
  }
  // What overflows is read as the largest number that there is.
  constexpr std::int64_t kLargestSeed = std::numeric_limits<std::int64_t>::max() - 1;
  if (request.seed && (*request.seed < 0 || *request.seed > kLargestSeed)) {
    throw UsageError(fmt::format("--seed is {}: it must be 0 to {}", *request.seed, kLargestSeed));
  }
  constexpr double kMost = 1e9;
  if (request.slower_than && !(*request.slower_than >= 1.0 && *request.slower_than <= kMost)) {
    throw UsageError(fmt::format("--slower-than is {:g}: it must be 1 to {:g} times the fastest",
                                 *request.slower_than, kMost));
  }
  if (request.patience && !(*request.patience > 0.0 && *request.patience <= kMost)) {
    throw UsageError(fmt::format("--patience is {:g} s: it must be above 0, at most {:g} s",
                                 *request.patience, kMost));
  }
}

PlannedScene plan_scene(const std::string& name, const BenchRequest& request) {
  Scene scene = load_scene(name);
  const StepSettings settings = request.settings(scene.model);
  const int steps = request.steps.value_or(default_steps(scene, settings.step));
  Stretch stretch = make_stretch(scene, settings.step, steps, request.start, settings.scheme);
  const double n = scene.model.variables();
  const double fill = 100.0 * static_cast<double>(tangent_nonzeros(scene.model)) / (n * n);
  return {std::move(scene), settings, std::move(stretch), fill};
}

/// The variants asked for; `control` becomes whether the null control is among them, which a
/// summary has only if it is named.
std::vector<NamedVariant> choose_variants(std::vector<std::string> names, bool summary,
                                          bool& control) {
  const bool everything = names.empty();
  const auto removed = std::erase_if(
      names, [](const std::string& name) { return name == "null" || name == kControl; });
  control = (everything && !summary) || removed > 0;
  if (names.empty() && !everything) return {};
  std::vector<std::string> twins;
  std::erase_if(names, [&twins](const std::string& name) {
    if (!name.ends_with(kTwin)) return false;
    twins.push_back(name.substr(0, name.size() - kTwin.size()));
    return true;
  });
  auto chosen = names.empty() && !twins.empty() ? std::vector<NamedVariant>() : select_variants(names);
  for (NamedVariant& one : twins.empty() ? std::vector<NamedVariant>() : select_variants(twins)) {
    one.name += kTwin;
    chosen.push_back(std::move(one));
  }
  if (everything) {
    std::erase_if(chosen, [](const NamedVariant& one) {
      return one.entry->implementation.role == Role::example;
    });
  }
  return chosen;
}

}  // namespace

std::string PlannedCell::variant_name() const {
  return name.substr(0, name.size() - scene->scene.name.size() - 1);
}

int default_steps(const Scene& scene, double step) {
  const int most = most_steps(scene.model.variables());
  if (!scene.four_bar_loops) return most;
  const double singular = FourBarExact(*scene.four_bar_loops).first_singular_time();
  const bool crosses = *scene.four_bar_loops <= kMostLoopsToCross;
  const double room =
      crosses ? 2 * std::floor(singular / step) : std::floor((singular - kClearance) / step);
  return static_cast<int>(std::clamp<double>(room, crosses ? 2 : 1, most));
}

BenchPlan plan_bench(const BenchRequest& request) {
  check(request);
  check_timing(request);
  bool control = false;
  const std::vector<NamedVariant> variants =
      choose_variants(request.implementations, request.summary, control);
  std::vector<std::string> names = request.scenes;
  if (names.empty()) names = {"four-bar:10", "four-bar:40"};
  BenchPlan plan;
  for (const std::string& name : names) {
    if (std::ranges::count(names, name) > 1) {
      throw UsageError(fmt::format("scene '{}' is given twice", name));
    }
    if (request.watch) request.watch(fmt::format("{}: reading the scene", name));
    const PlannedScene* scene = &plan.scenes.emplace_back(plan_scene(name, request));
    const std::string& shown = scene->scene.name;
    if (control && !request.operations && !request.batch) {
      plan.cells.push_back({fmt::format("{}/{}", kControl, shown), scene, &null_variant(), true});
    }
    for (const NamedVariant& variant : variants) {
      // Asked for by name it becomes a row that says so.
      const bool offers = (!request.operations || variant.variant->operations != nullptr) &&
                          (!request.batch || variant.variant->create_batch != nullptr);
      if (!offers && request.implementations.empty()) continue;
      plan.cells.push_back({fmt::format("{}/{}", variant.name, shown), scene, variant.variant, false,
                            variant.entry == nullptr ||
                                is_own_code(variant.entry->implementation, *variant.variant)});
    }
  }
  if (plan.cells.empty()) {
    throw UsageError(request.batch
                         ? "--batch: no implementation of this build advances lanes side by side"
                         : "--operations: no implementation of this build offers them one by one");
  }
  return plan;
}

std::vector<PlannedCell> filter_cells(const std::vector<PlannedCell>& cells, std::string filter) {
  if (filter.empty() || filter == "all") return cells;
  const std::string given = filter;
  const bool negative = filter.starts_with('-');
  if (negative) filter.erase(0, 1);
  std::vector<PlannedCell> result;
  try {
    const RegularExpression expression(filter);
    std::ranges::copy_if(cells, std::back_inserter(result), [&](const PlannedCell& cell) {
      return expression.found_in(cell.name) != negative;
    });
  } catch (const UsageError& error) {
    throw UsageError(
        fmt::format("--benchmark_filter={} is no regular expression: {}", given, error.what()));
  }
  if (result.empty()) {
    std::vector<std::string> names;
    for (const PlannedCell& cell : cells) names.push_back(cell.name);
    throw UsageError(
        fmt::format("--benchmark_filter={} selects none of: {}", given, fmt::join(names, ", ")));
  }
  return result;
}

}  // namespace mbs
