// Cuts and shuffles.
#include "bench/turns.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace mbs {

void shuffle(std::vector<std::size_t>& order, RandomOrder& random) {
  for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random() % i]);
}

Turns plan_turns(int steps, std::span<const double> seconds, double typical, double slice) {
  constexpr double kShortest = 1e-6;  // s; reading the clocks takes as long
  constexpr double kMostRepeats = 1e9;
  const double wanted = slice > 0.0 ? std::round(typical / slice) : 1.0;
  const int count = static_cast<int>(std::clamp<double>(wanted, 1, steps));
  Turns turns{steps, (steps - 1) / count + 1, std::vector<long>(seconds.size(), 1)};
  if (turns.chunk < steps) return turns;
  std::ranges::transform(seconds, turns.repeats.begin(), [&](double stretch) {
    const double repeats = std::round(slice / std::max(stretch, kShortest));
    return static_cast<long>(std::clamp(repeats, 1.0, kMostRepeats));
  });
  return turns;
}

void take_turns(const Turns& turns, RandomOrder& random,
                const std::function<void(const Turn&)>& take) {
  std::vector<std::size_t> order(turns.repeats.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  int steps = 0;
  for (int first = 0; first < turns.steps; first += steps) {
    steps = std::min(turns.chunk, turns.steps - first);
    shuffle(order, random);
    for (const std::size_t i : order) take({i, first, steps, turns.repeats[i]});
  }
}

}  // namespace mbs
