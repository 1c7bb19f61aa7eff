// Checks on the whole scene, in the order in which their messages help most.
#include "scene_file/scene_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "model_math/jacobian_rank.hpp"
#include "model_math/kinematics.hpp"
#include "model_math/least_change.hpp"
#include "printable.hpp"
#include "scene/row_names.hpp"
#include "usage_error.hpp"

namespace mbs {
namespace {

[[noreturn]] void refuse(const std::string& where, const std::string& what) {
  throw UsageError(fmt::format("{}: {}", printable(where), what));
}

/// Index of the point that owns each coordinate.
std::vector<std::size_t> owners(const ModelData& data) {
  std::vector<std::size_t> result(data.initial_velocity.size());
  for (std::size_t i = 0; i < data.points.size(); ++i) {
    if (data.points[i].is_fixed()) continue;
    std::fill_n(result.begin() + data.points[i].offset, data.dimension, i);
  }
  return result;
}

class MobilityCheck {
 public:
  MobilityCheck(const Lowered& lowered, const std::string& where)
      : lowered_(lowered), where_(where), model_(lowered.data.model) {}

  /// Constraints that involve one free point only must not outnumber what they hold.
  void check_over_fixed() {
    entries_ = jacobian(model_, 0.0, model_.initial_position());
    const std::vector<std::size_t> owner_of = owners(lowered_.data.model);
    std::map<std::size_t, std::vector<std::pair<std::size_t, std::size_t>>> rows_of;  // of a point
    for (std::size_t begin = 0; begin < entries_.size();) {
      std::size_t end = begin;
      bool is_alone = true;
      const std::size_t owner = owner_of[static_cast<std::size_t>(entries_[begin].col)];
      for (; end < entries_.size() && entries_[end].row == entries_[begin].row; ++end) {
        is_alone = is_alone && owner_of[static_cast<std::size_t>(entries_[end].col)] == owner;
      }
      if (is_alone) rows_of[owner].emplace_back(begin, end);
      begin = end;
    }
    for (const auto& [owner, rows] : rows_of) {
      if (rows.size() <= static_cast<std::size_t>(model_.dimension())) continue;
      std::vector<JacobianEntry> local;
      std::string names;
      for (std::size_t i = 0; i < rows.size(); ++i) {
        for (std::size_t k = rows[i].first; k < rows[i].second; ++k) {
          local.push_back({static_cast<int>(i), entries_[k].col - model_.points()[owner].offset,
                           entries_[k].value});
        }
        if (i < 8) names += (i == 0 ? "" : ", ") + row_name(model_, row_of(rows[i].first));
      }
      if (rank_of(static_cast<int>(rows.size()), model_.dimension(), local) < model_.dimension()) {
        continue;
      }
      refuse(
          where_,
          fmt::format("{}: found an over-fixed point: {} rods or constraints to fixed points ({}) "
                      "hold its {} coordinates, allowed are at most {}",
                      lowered_.labels[owner], rows.size(), names, model_.dimension(),
                      model_.dimension()));
    }
  }

  void check_mobility() const {
    const int n = model_.variables();
    const auto rank = jacobian_rank(model_, model_.initial_position());
    if (rank && *rank == n && !is_driven(model_)) {
      refuse(
          where_,
          fmt::format("the scene cannot move: its constraints hold all {} coordinates (rank {} at "
                      "the start), allowed is at least one degree of freedom",
                      n, *rank));
    }
    if (rank && *rank == n - 1 && *rank < model_.constraints() && !is_driven(model_)) {
      refuse_second_order();
    }
    if (!rank && model_.constraints() > n) {
      refuse(where_,
             fmt::format("found {} constraints on {} coordinates, allowed are at most as many",
                         model_.constraints(), n));
    }
  }

 private:
  /// One direction v is left by Phi_q v = 0. A motion along it has Phi_q a = -(Phi_q)' v, which
  /// redundant constraints of a mechanism allow, and stretched ones of a framework do not.
  void refuse_second_order() const {
    const std::span<const double> q = model_.initial_position();
    const auto rows = static_cast<std::size_t>(model_.constraints());
    const LeastChange least(model_, 0.0, q);
    const auto times_jacobian = [&](const std::vector<double>& x) {
      std::vector<double> result(rows);
      constraint_rate(model_, 0.0, q, x, result);  // Phi_t is 0
      return result;
    };
    std::vector<double> v(q.size());
    for (std::size_t i = 0; i < v.size(); ++i) v[i] = 1.0 + 0.5 * std::sin(1.0 + 2.0 * i);
    for (int pass = 0; pass < 2; ++pass) {
      const std::vector<double> off = least.solve(times_jacobian(v));
      for (std::size_t i = 0; i < v.size(); ++i) v[i] -= off[i];
    }
    std::vector<double> curvature(rows);
    constraint_curvature(model_, 0.0, q, v, curvature);
    const std::vector<double> rate = times_jacobian(least.solve(curvature));
    double size = 0.0, rest = 0.0;
    for (std::size_t k = 0; k < rows; ++k) {
      size = std::hypot(size, curvature[k]);
      rest = std::hypot(rest, curvature[k] - rate[k]);
    }
    constexpr double kRest = 1e-6;  // share of the curvature that is no rounding
    if (!(rest > kRest * size)) return;
    refuse(where_,
           fmt::format("the scene cannot move: its constraints are stretched or folded at the "
                       "start, where they hold {} of {} coordinates at first order and the last at "
                       "second, allowed is at least one degree of freedom",
                       model_.variables() - 1, model_.variables()));
  }

  [[nodiscard]] int row_of(std::size_t entry) const { return entries_[entry].row; }

  const Lowered& lowered_;
  const std::string& where_;
  Model model_;
  std::vector<JacobianEntry> entries_;
};

}  // namespace

void check_scene(const Lowered& lowered, const std::string& where) {
  const ModelData& data = lowered.data.model;
  if (data.initial_velocity.empty()) {
    refuse(where, "points: found no free point, allowed is at least one");
  }
  const std::vector<std::size_t> owner_of = owners(data);
  for (const MassEntry& entry : data.mass) {
    if (entry.row != entry.col || entry.value > 0.0) continue;
    const std::size_t owner = owner_of[static_cast<std::size_t>(entry.row)];
    refuse(where,
           lowered.labels[owner] +
               (data.points[owner].is_vector
                    ? ": found a free unit vector without mass, allowed are fixed unit "
                      "vectors and those of a body"
                    : ": found a free point without mass, allowed are free points at a mass, "
                      "at a rod with mass or on a body"));
  }
  MobilityCheck(lowered, where).check_over_fixed();
}

void check_mobility(const Lowered& lowered, const std::string& where) {
  MobilityCheck(lowered, where).check_mobility();
}

}  // namespace mbs
