// Who runs when: the order in which the contenders of a scene are timed.
#pragma once

#include <cstdint>
#include <functional>
#include <random>
#include <span>
#include <vector>

namespace mbs {

/// How one sample of each contender is cut. A stretch of 10 steps in turns of 4:
///
///   steps 0-3: b a c    steps 4-7: a c b    steps 8-9: c b a
///
/// A stretch that is shorter than a turn should be is repeated within it instead.
struct Turns {
  int steps = 0;              ///< of the stretch
  int chunk = 0;              ///< steps of a turn, 1 to `steps`; the last turn may have fewer
  std::vector<long> repeats;  ///< stretches of a turn, by contender; 1 unless chunk == steps

  /// Turns of a contender in one sample.
  [[nodiscard]] int count() const { return (steps - 1) / chunk + 1; }
};

/// Cuts so that a turn of a contender that takes `typical` seconds a stretch lasts about `slice`
/// seconds; if that is the whole stretch, contender i, which takes `seconds[i]`, repeats it until
/// its turn lasts that long. The results depend on nothing else.
/// @param steps of the stretch, at least 1
/// @param slice at least 0, which means a whole stretch, once
Turns plan_turns(int steps, std::span<const double> seconds, double typical, double slice);

/// One turn: `repeats` times the steps `first` ... `first + steps - 1` of the stretch.
struct Turn {
  std::size_t contender = 0;
  int first = 0, steps = 0;
  long repeats = 1;
};

using RandomOrder = std::mt19937_64;

/// Fisher and Yates; std::shuffle may differ from one library to the next.
void shuffle(std::vector<std::size_t>& order, RandomOrder& random);

/// Calls `take` for every turn of one sample, chunk by chunk: every contender once in each, in an
/// order that is shuffled anew. The same `random` gives the same orders on every machine.
void take_turns(const Turns& turns, RandomOrder& random,
                const std::function<void(const Turn&)>& take);

}  // namespace mbs
