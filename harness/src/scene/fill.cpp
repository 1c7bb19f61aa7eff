// Counts the tangent's non-zeros and adds artificial ones to M.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "scene/scene.hpp"
#include "scene/tangent_pattern.hpp"
#include "usage_error.hpp"

namespace mbs {
namespace {

/// Uniform in 0 ... below - 1. The standard's distributions differ between libraries, this does
/// not.
std::uint64_t uniform(std::mt19937_64& random, std::uint64_t below) {
  const std::uint64_t largest = std::mt19937_64::max() - std::mt19937_64::max() % below;
  std::uint64_t draw = random();
  while (draw >= largest) draw = random();
  return draw % below;
}

/// `count` different numbers out of 0 ... total - 1, ascending, every set equally likely.
/// Needs count <= total / 2 to be quick.
std::vector<std::uint64_t> draw_distinct(std::uint64_t total, std::uint64_t count,
                                         std::mt19937_64& random) {
  std::vector<std::uint64_t> drawn;
  drawn.reserve(count);
  // Each round draws what is missing, so the result is the first `count` distinct draws.
  while (drawn.size() < count) {
    const auto old = static_cast<std::ptrdiff_t>(drawn.size());
    while (drawn.size() < count) drawn.push_back(uniform(random, total));
    std::sort(drawn.begin() + old, drawn.end());
    std::inplace_merge(drawn.begin(), drawn.begin() + old, drawn.end());
    drawn.erase(std::unique(drawn.begin(), drawn.end()), drawn.end());
  }
  return drawn;
}

std::vector<std::uint64_t> choose(std::uint64_t total, std::uint64_t count, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  if (count <= total / 2) return draw_distinct(total, count, random);
  const std::vector<std::uint64_t> left_out = draw_distinct(total, total - count, random);
  std::vector<std::uint64_t> chosen;
  chosen.reserve(count);
  auto skip = left_out.begin();
  for (std::uint64_t i = 0; i < total; ++i) {
    if (skip != left_out.end() && *skip == i) {
      ++skip;
    } else {
      chosen.push_back(i);
    }
  }
  return chosen;
}

/// Adds zeros at the absent pairs with these ascending ranks; absent pairs are ranked by column,
/// then row.
void add_zeros(std::vector<MassEntry>& mass, const Model& model,
               const std::vector<std::uint64_t>& ranks) {
  TangentPattern pattern(model);
  std::vector<int> present;
  std::uint64_t column_begin = 0;  // rank of the column's first absent pair
  auto rank = ranks.begin();
  for (int col = 0; col < model.variables() && rank != ranks.end(); ++col) {
    const auto below = pattern.below(col);
    present.assign(below.begin(), below.end());
    std::sort(present.begin(), present.end());
    const auto rows = static_cast<std::uint64_t>(model.variables() - 1 - col);
    const std::uint64_t column_end = column_begin + rows - present.size();
    std::size_t passed = 0;  // present rows above the row sought
    for (; rank != ranks.end() && *rank < column_end; ++rank) {
      const int first = col + 1 + static_cast<int>(*rank - column_begin);
      while (passed < present.size() && present[passed] <= first + static_cast<int>(passed)) {
        ++passed;
      }
      mass.push_back({first + static_cast<int>(passed), col, 0.0});
    }
    column_begin = column_end;
  }
}

}  // namespace

long tangent_nonzeros(const Model& model) {
  TangentPattern pattern(model);
  long below = 0;
  for (int col = 0; col < model.variables(); ++col) {
    below += static_cast<long>(pattern.below(col).size());
  }
  return model.variables() + 2 * below;
}

Fill add_fill(ModelData& data, double asked, std::uint64_t seed) {
  if (!(asked > 0.0 && asked <= 1.0)) {
    throw UsageError(fmt::format("fill: found {}, allowed is a share above 0, up to 1", asked));
  }
  const Model model(data);
  const double n = model.variables();
  const double wanted = asked * n * n;
  if (wanted > static_cast<double>(kMostFilledPositions)) {
    throw UsageError(fmt::format(
        "fill: {} of {} x {} makes {:.3g} positions in the tangent, allowed are at most {}", asked,
        n, n, wanted, kMostFilledPositions));
  }
  const long natural = tangent_nonzeros(model);
  const double missing = wanted - static_cast<double>(natural);
  if (missing <= -1.0) {
    throw UsageError(fmt::format(
        "fill: {} is not reached: the tangent's natural fill is already {:.6g}, allowed are {:.6g} "
        "to 1",
        asked, static_cast<double>(natural) / (n * n),
        std::ceil(1e6 * static_cast<double>(natural) / (n * n)) / 1e6));
  }
  const auto pairs = static_cast<std::uint64_t>(std::max(0L, std::lround(missing / 2.0)));
  const auto size = static_cast<std::uint64_t>(model.variables());
  const std::uint64_t absent = (size * size - static_cast<std::uint64_t>(natural)) / 2;
  data.mass.reserve(data.mass.size() + pairs);
  add_zeros(data.mass, model, choose(absent, pairs, seed));
  return {asked, static_cast<double>(natural) / (n * n),
          (static_cast<double>(natural) + 2.0 * static_cast<double>(pairs)) / (n * n), seed};
}

}  // namespace mbs
