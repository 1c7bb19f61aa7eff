// The cells that `mbs bench` times: scenes with their settings and stretches, times variants.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bench/measurement.hpp"
#include "registry/registry.hpp"

namespace mbs {

inline constexpr int kSets = 64;

/// What is being done, for a line of progress.
using Watch = std::function<void(const std::string&)>;

/// As given on the command line.
struct BenchRequest {
  std::vector<std::string> scenes;           ///< empty: four-bar:10 and four-bar:40
  std::vector<std::string> implementations;  ///< empty: all, and the null control "null/null"
  /// Settings for a model; "auto" needs the model. Throws UsageError.
  std::function<StepSettings(const Model&)> settings;
  std::optional<int> steps;
  std::optional<double> start;  ///< s
  bool phases = false;
  bool operations = false;  ///< the operations of Table 2 instead of steps
  bool batch = false;       ///< many lanes at once, and alone, instead of single simulations
  bool summary = false;     ///< steps, for a reader in a hurry: the control only if named
  std::optional<int> sets;  ///< of parameters, with batch; kSets if not given
  Watch watch;              ///< if any
  // Not with operations or batch; scene_timing.hpp says what they mean.
  std::optional<std::int64_t> seed;  ///< at least 0
  std::optional<double> slower_than, patience;
};

/// A scene with what is common to all of its cells.
struct PlannedScene {
  Scene scene;
  StepSettings settings;
  Stretch stretch;
  double fill_percent = 0.0;  ///< of the tangent's n^2 positions, 100 for all
};

struct PlannedCell {
  std::string name;  ///< "folder/variant/scene"
  const PlannedScene* scene = nullptr;
  const Variant* variant = nullptr;
  bool control = false;
  bool own_code = false;  ///< on no library

  /// "folder/variant"
  [[nodiscard]] std::string variant_name() const;
};

struct BenchPlan {
  std::deque<PlannedScene> scenes;  ///< a deque, so that cells can point into it
  std::vector<PlannedCell> cells;   ///< scene by scene, the control first
};

/// Loads the scenes and chooses what was left open. Throws UsageError.
BenchPlan plan_bench(const BenchRequest& request);

/// Number of steps of a stretch if the user does not say: most_steps(), on the N-four-bar cut to
/// what fits between t = 0 and where make_stretch() has it end. `step` in s.
int default_steps(const Scene& scene, double step);

/// The cells whose name the regular expression finds, as Google Benchmark filters: extended POSIX
/// syntax, a leading '-' for those it does not find, "" or "all" for every one. Throws UsageError
/// if it is no regular expression or selects nothing.
std::vector<PlannedCell> filter_cells(const std::vector<PlannedCell>& cells, std::string filter);

}  // namespace mbs
