// Ranks at two positions.
#include "describe/structure.hpp"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <random>

#include "model_math/consistency.hpp"
#include "model_math/jacobian_rank.hpp"
#include "model_math/shortest_lengths.hpp"

namespace mbs {
namespace {

constexpr double kMove = 1e-3;  // of the shortest length at a point, or m without one
constexpr std::uint64_t kSeed = 20'080'607;
constexpr double kNearEnough = 1e-11;  // violation up to which the position nearby is used

/// A position near the start on the constraints, or none if the way back there fails.
std::optional<std::vector<double>> position_nearby(const Model& model) {
  std::vector<double> q(model.initial_position().begin(), model.initial_position().end());
  const std::vector<double> lengths = shortest_lengths(model);
  std::mt19937_64 random(kSeed);
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    const Point& point = model.points()[i];
    if (point.is_fixed()) continue;
    const double move = kMove * (lengths[i] > 0.0 ? lengths[i] : 1.0);
    for (int axis = 0; axis < model.dimension(); ++axis) {
      // In -1 ... 1, the same on every platform.
      const double draw = 2.0 * static_cast<double>(random() >> 11) * 0x1p-53 - 1.0;
      q[static_cast<std::size_t>(point.offset + axis)] += move * draw;
    }
  }
  if (!(move_onto_constraints(model, 0.0, q).ratio <= kNearEnough)) return std::nullopt;
  return q;
}

std::optional<RowRank> rank_at(const Model& model, std::span<const double> q) {
  return find_rank(model.constraints(), model.variables(), jacobian(model, 0.0, q));
}

}  // namespace

Structure find_structure(const Model& model) {
  Structure result;
  const auto at_start = rank_at(model, model.initial_position());
  if (!at_start) return result;
  result.rank_at_start = result.rank = at_start->rank;
  result.redundant = at_start->dependent;
  if (at_start->dependent.empty()) {  // full rank stays full nearby
    result.singular = false;
    return result;
  }
  const auto nearby = position_nearby(model);
  const auto rank_nearby = nearby ? rank_at(model, *nearby) : std::nullopt;
  if (!rank_nearby) return result;
  result.singular = rank_nearby->rank > at_start->rank;
  if (!*result.singular) return result;
  result.rank = rank_nearby->rank;
  result.redundant = rank_nearby->dependent;
  std::ranges::set_difference(at_start->dependent, rank_nearby->dependent,
                              std::back_inserter(result.singular_rows));
  return result;
}

}  // namespace mbs
