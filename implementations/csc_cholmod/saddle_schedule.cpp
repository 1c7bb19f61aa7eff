// Walks over rows of Phi_q and of gradients.
#include "saddle_schedule.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <utility>

#include "elimination_order.hpp"
#include "schedule.hpp"

namespace mbs::csc_cholmod {
namespace {

/// Visits (row, column) of each entry of Phi_q, linear rows last.
template <typename Visit>
void for_jacobian(const LoweredConstraints& lowered, Visit visit) {
  const SignedRows& rows = lowered.entries();
  for (int row = 0; row < rows.rows(); ++row) {
    for (const SignedEntry& e : rows[row]) visit(row, e.column);
  }
  const LinearBlock& linear = lowered.linear;
  for (std::size_t t = 0; t < linear.row.size(); ++t) visit(linear.row[t], linear.column[t]);
}

/// Places of the model's unknowns, which the coordinates have numbered already.
std::vector<int> model_places(const Coordinates& coordinates, const std::vector<int>& place) {
  std::vector<int> result;
  for (int number : coordinates.number()) result.push_back(place[number]);
  return result;
}

constexpr double kFarBelow = 1e-3;

/// Lets rows that are not linear own the point that no other row has. It must not be far heavier
/// than the row's others, which lean on it.
void own_points(const Model& model, const Coordinates& coordinates,
                const LoweredConstraints& lowered, std::vector<int>& owner) {
  std::vector<double> mass(owner.size()), lightest(lowered.rows(), HUGE_VAL);
  for (const MassEntry& e : model.mass()) {
    if (e.row == e.col) mass[coordinates.number()[e.row]] = e.value;
  }
  constexpr int kNone = -1, kMany = -2;
  std::vector<int> row_with(owner.size(), kNone);
  for_jacobian(lowered, [&](int row, int column) {
    int& only = row_with[column];
    only = only == kNone || only == row ? row : kMany;
    lightest[row] = std::min(lightest[row], mass[column]);
  });
  for (std::size_t p = 0; p < model.points().size(); ++p) {
    if (model.points()[p].is_fixed()) continue;
    std::vector<int> columns;
    for (int axis = 0; axis < model.dimension(); ++axis) {
      columns.push_back(coordinates.place(static_cast<int>(p), axis));
    }
    const int row = row_with[columns[0]];
    const auto is_alone = [&](int column) { return row_with[column] == row; };
    if (row < 0 || row >= lowered.linear.first_row || !std::ranges::all_of(columns, is_alone) ||
        kFarBelow * mass[columns[0]] > lightest[row]) {
      continue;
    }
    for (const int column : columns) owner[column] = row;
  }
}

/// By unknown: the row that owns it, or -1. A linear row is a substitution for the one with the
/// largest coefficient of those that no other linear row has, unless that is far below its largest.
std::vector<int> owners(const Model& model, const Coordinates& coordinates,
                        const LoweredConstraints& lowered) {
  const LinearBlock& linear = lowered.linear;
  std::vector<int> rows_with(coordinates.unknowns()), owner(coordinates.unknowns(), -1);
  own_points(model, coordinates, lowered, owner);
  for (int column : linear.column) ++rows_with[column];
  for (int row = 0; row < linear.count; ++row) {
    double largest = 0.0, most = 0.0;
    int owned = -1;
    for (int t = linear.start[row]; t < linear.start[row + 1]; ++t) {
      const double size = std::abs(linear.coefficient[t]);
      largest = std::max(largest, size);
      if (rows_with[linear.column[t]] > 1 || size <= most) continue;
      most = size;
      owned = linear.column[t];
    }
    if (most > kFarBelow * largest) owner[owned] = linear.first_row + row;
  }
  return owner;
}

/// Of the unknowns, then of the rows: which unknowns come before.
Before unknowns_before(const Model& model, const Coordinates& coordinates,
                       const LoweredConstraints& lowered) {
  const int unknowns = coordinates.unknowns();
  const std::vector<int> owner = owners(model, coordinates, lowered);
  std::vector<std::vector<int>> columns(lowered.rows());
  for_jacobian(lowered, [&](int row, int column) { columns[row].push_back(column); });
  Before owned(lowered.rows());
  for (int column = 0; column < unknowns; ++column) {
    if (owner[column] >= 0) owned[owner[column]].push_back(column);
  }
  Before result(unknowns);
  for (int row = 0; row < lowered.rows(); ++row) {
    std::vector<int> needed = owned[row];
    if (needed.empty()) {
      needed = columns[row];
      for (int column : columns[row]) {
        if (owner[column] < 0) continue;
        const std::vector<int>& more = columns[owner[column]];
        needed.insert(needed.end(), more.begin(), more.end());
      }
    }
    std::ranges::sort(needed);
    needed.erase(std::unique(needed.begin(), needed.end()), needed.end());
    result.push_back(std::move(needed));
  }
  return result;
}

}  // namespace

std::vector<int> saddle_places(const Model& model, Method method) {
  const Coordinates coordinates(model, fill_reducing_order(tangent_pattern(model), method));
  const LoweredConstraints lowered(model, coordinates);
  const int unknowns = coordinates.unknowns();
  const Before before = unknowns_before(model, coordinates, lowered);
  const int n = static_cast<int>(before.size());
  std::vector<int> last(n), order(n);
  std::iota(last.begin(), last.end(), 0);
  std::iota(order.begin(), order.end(), 0);
  for (int k = unknowns; k < n; ++k) {
    last[k] = before[k].empty() ? -1 : std::ranges::max(before[k]);
  }
  std::ranges::stable_sort(order, {}, [&](int k) { return last[k]; });
  std::vector<int> place(n), result(n);
  for (int k = 0; k < n; ++k) place[order[k]] = k;
  if (method.tuning == Tuning::own) {
    std::vector<int> same(n);
    std::iota(same.begin(), same.end(), 0);
    const HalfPattern pattern = saddle_pattern(
        model, coordinates, lowered, LoweredForces(model, coordinates), same, Half::lower);
    place = low_order(n, pattern.positions(), order, before);
  }
  for (int i = 0; i < unknowns; ++i) result[i] = place[coordinates.number()[i]];
  std::copy(place.begin() + unknowns, place.end(), result.begin() + unknowns);
  return result;
}

HalfPattern saddle_pattern(const Model& model, const Coordinates& coordinates,
                           const LoweredConstraints& lowered, const LoweredForces& forces,
                           const std::vector<int>& place, Half half) {
  const int unknowns = coordinates.unknowns();
  const std::vector<int> model_place = model_places(coordinates, place);
  std::vector<Position> positions;
  for (const MassEntry& e : model.mass()) {
    positions.push_back({model_place[e.row], model_place[e.col]});
  }
  for_pairs(forces.gradients(), [&](int, const SignedEntry& e, const SignedEntry& f) {
    positions.push_back({place[e.column], place[f.column]});
  });
  for_jacobian(lowered, [&](int row, int column) {
    positions.push_back({place[unknowns + row], place[column]});
  });
  for (std::size_t k = unknowns; k < place.size(); ++k) positions.push_back({place[k], place[k]});
  return HalfPattern(half, static_cast<int>(place.size()), positions);
}

std::vector<double> saddle_constants(const Model& model, const StepSettings& settings,
                                     const Coordinates& coordinates,
                                     const LoweredConstraints& lowered,
                                     const std::vector<int>& place, const HalfPattern& pattern) {
  const int unknowns = coordinates.unknowns();
  const double epsilon = 4.0 / (settings.penalty * settings.step * settings.step);
  std::vector<double> values = mass_values(model, pattern, model_places(coordinates, place));
  for (std::size_t k = unknowns; k < place.size(); ++k) {
    values[pattern.index({place[k], place[k]})] = -epsilon;  // Eq. (12)
  }
  const LinearBlock& linear = lowered.linear;
  for (std::size_t t = 0; t < linear.row.size(); ++t) {
    values[pattern.index({place[unknowns + linear.row[t]], place[linear.column[t]]})] =
        linear.coefficient[t];  // Eq. (8)
  }
  return values;
}

std::vector<Contribution> saddle_contributions(const LoweredConstraints& lowered,
                                               const LoweredForces& forces,
                                               const std::vector<int>& place,
                                               const HalfPattern& pattern) {
  const int unknowns = static_cast<int>(place.size()) - lowered.rows();
  const SignedRows& rows = lowered.entries();
  std::vector<Contribution> result;
  for (int row = 0; row < rows.rows(); ++row) {
    for (const SignedEntry& e : rows[row]) {
      const int target = pattern.index({place[unknowns + row], place[e.column]});
      result.push_back({target, e.value + (e.negative ? lowered.values() : 0)});
    }
  }
  for_pairs(forces.gradients(), [&](int row, const SignedEntry& e, const SignedEntry& f) {
    const int source = 2 * lowered.values() + signed_product(forces, row, e, f);
    result.push_back({pattern.index({place[e.column], place[f.column]}), source});
  });
  return result;
}

}  // namespace mbs::csc_cholmod
