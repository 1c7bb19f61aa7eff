// Times all contenders of a scene against each other, in turns within this process.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bench/bench_plan.hpp"
#include "bench/measurement.hpp"
#include "bench/turns.hpp"

namespace mbs {

inline constexpr double kSlice = 0.005;  ///< s
inline constexpr std::uint64_t kSeed = 1;
inline constexpr double kSceneTime = 2.0;  ///< s of samples of one scene, unless a number is given
inline constexpr int kLeastSamples = 3, kMostSamples = 100;  ///< that are chosen
inline constexpr int kLeastByLayer = 6;  ///< as kLeastSamples: with fewer there is no 95 % interval

struct TimingWishes {
  double slice = kSlice;              ///< s, see plan_turns()
  int samples = 0;                    ///< of each contender; 0: kSceneTime decides
  std::uint64_t seed = kSeed;         ///< of the orders: set-up, turns
  std::optional<double> slower_than;  ///< times the fastest; whoever takes longer is not timed
  std::optional<double> patience;     ///< s for the steps of the first stretch
  /// For an answer soon: `slower_than` is within a layer (libraries, own code), so that both have
  /// a winner; the likely fast are looked at first; a dense variant whose factorization alone would
  /// be too slow on any machine is not even set up.
  bool by_layer = false;
  /// s of processor time: where what is left does not fit, `slower_than` narrows to 5, 3 and 2.
  std::optional<double> budget;
  bool phases = false;
};

/// Times of one contender over the whole stretch.
struct Sample {
  Spent spent;         ///< in all of its stretches
  long stretches = 0;  ///< more than one where a stretch is shorter than a turn
};

struct ContenderResult {
  const PlannedCell* cell = nullptr;
  std::string failure;                 ///< a CellFailure's text, or "slower: ..."; else empty
  std::optional<double> look_seconds;  ///< processor time of a step, as first seen
  CellFigures figures;
  std::vector<Sample> samples;  ///< as many as the others have; none after a failure

  [[nodiscard]] bool timed() const { return failure.empty(); }
  /// Whether it was left out because it is slow.
  [[nodiscard]] bool slower() const { return failure.starts_with("slower"); }
  /// Whether something is wrong: what a variant does not offer and what is slow are answers.
  [[nodiscard]] bool failed() const {
    return !timed() && !slower() && !failure.starts_with("unsupported");
  }
  /// Processor time of a step in us, by sample.
  [[nodiscard]] std::vector<double> step_times() const;
};

struct SceneResult {
  const PlannedScene* scene = nullptr;
  Turns turns;
  int samples = 0;                          ///< asked of each contender
  std::vector<ContenderResult> contenders;  ///< in the order of the cells
};

/// Sets all contenders up, in a shuffled order, and warms them up one after the other; then takes samples, all of them
/// by turns. A sample of a contender is its time over the whole stretch, from the same start. All
/// are alive at once, none afterwards. A contender that fails, or is too slow, costs the others
/// nothing but its samples.
/// @param cells of one scene, at least one
SceneResult time_scene(std::span<const PlannedCell> cells, const TimingWishes& wishes,
                       const Watch& watch);

}  // namespace mbs
