// Checks on the whole scene, in the order in which their messages help most.
#include "scene/scene_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "model_math/jacobian_rank.hpp"
#include "model_math/kinematics.hpp"
#include "printable.hpp"
#include "usage_error.hpp"

namespace mbs {
namespace {

/// How far a constraint may be off, and how to say that it is.
struct Criterion {
  double tolerance;
  const char* what;
  const char* dot_unit;
  const char* linear_unit;
  const char* relative_to;
};

class SceneCheck {
 public:
  SceneCheck(const ModelData& data, const std::string& where) : data_(data), where_(where) {}

  void run() {
    owner_ = owners();
    check_points();
    const Model model(data_);
    entries_ = jacobian(model, model.initial_position());
    check_over_fixed(model);
    check_position(model);
    check_velocity(model);
    check_mobility(model);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw UsageError(fmt::format("{}: {}", printable(where_), what));
  }

  [[nodiscard]] std::string point_label(std::size_t index) const {
    return fmt::format("points[{}] {}", index, in_quotes(data_.points[index].name));
  }

  [[nodiscard]] const std::string& constraint_name(std::size_t row) const {
    const std::size_t dots = data_.dot_constraints.size();
    return row < dots ? data_.dot_constraints[row].name : data_.linear_constraints[row - dots].name;
  }

  /// Index of the point that owns each coordinate.
  [[nodiscard]] std::vector<std::size_t> owners() const {
    std::vector<std::size_t> result(data_.force.size());
    for (std::size_t i = 0; i < data_.points.size(); ++i) {
      if (data_.points[i].is_fixed()) continue;
      std::fill_n(result.begin() + data_.points[i].offset, data_.dimension, i);
    }
    return result;
  }

  void check_points() const {
    if (owner_.empty()) fail("points: found no free point, allowed is at least one");
    std::vector<bool> touched(data_.points.size(), false);
    for (const DotConstraint& constraint : data_.dot_constraints) {
      for (const int index : {constraint.a, constraint.b, constraint.c, constraint.d}) {
        touched[static_cast<std::size_t>(index)] = true;
      }
    }
    for (const LinearConstraint& constraint : data_.linear_constraints) {
      for (const auto& term : constraint.terms) {
        touched[owner_[static_cast<std::size_t>(term.coordinate)]] = true;
      }
    }
    for (std::size_t i = 0; i < data_.points.size(); ++i) {
      const Point& point = data_.points[i];
      const bool has_mass =
          !point.is_fixed() && data_.mass[static_cast<std::size_t>(point.offset)].value > 0.0;
      if (!touched[i] && !has_mass) {
        fail(point_label(i) +
             ": found an unconnected point, allowed are points that a rod, mass or "
             "constraint touches");
      }
      if (!point.is_fixed() && !has_mass) {
        fail(point_label(i) +
             ": found a free point without mass, allowed are free points at a mass "
             "or at a rod with mass");
      }
    }
  }

  /// Constraints that involve one free point only must not outnumber what they hold.
  void check_over_fixed(const Model& model) const {
    std::map<std::size_t, std::vector<std::pair<std::size_t, std::size_t>>> rows_of;  // of a point
    for (std::size_t begin = 0; begin < entries_.size();) {
      std::size_t end = begin;
      bool is_alone = true;
      const std::size_t owner = owner_[static_cast<std::size_t>(entries_[begin].col)];
      for (; end < entries_.size() && entries_[end].row == entries_[begin].row; ++end) {
        is_alone = is_alone && owner_[static_cast<std::size_t>(entries_[end].col)] == owner;
      }
      if (is_alone) rows_of[owner].emplace_back(begin, end);
      begin = end;
    }
    for (const auto& [owner, rows] : rows_of) {
      if (rows.size() <= static_cast<std::size_t>(model.dimension())) continue;
      std::vector<JacobianEntry> local;
      std::string names;
      for (std::size_t i = 0; i < rows.size(); ++i) {
        for (std::size_t k = rows[i].first; k < rows[i].second; ++k) {
          local.push_back({static_cast<int>(i), entries_[k].col - data_.points[owner].offset,
                           entries_[k].value});
        }
        if (i < 8) names += (i == 0 ? "" : ", ") + constraint_name(row_of(rows[i].first));
      }
      if (rank_of(static_cast<int>(rows.size()), model.dimension(), local) < model.dimension()) {
        continue;
      }
      fail(fmt::format(
          "{}: found an over-fixed point: {} rods or constraints to fixed points ({}) "
          "hold its {} coordinates, allowed are at most {}",
          point_label(owner), rows.size(), names, model.dimension(), model.dimension()));
    }
  }

  void check_position(const Model& model) const {
    std::vector<double> phi(static_cast<std::size_t>(model.constraints()));
    evaluate_constraints(model, model.initial_position(), phi);
    std::vector<double> scale;
    for (const DotConstraint& constraint : data_.dot_constraints) {
      scale.push_back(
          std::max(distance(constraint.a, constraint.b) * distance(constraint.c, constraint.d),
                   std::abs(constraint.value)));
    }
    const double extent = largest_coordinate();
    for (const LinearConstraint& constraint : data_.linear_constraints) {
      double coefficients = 0.0;
      for (const auto& term : constraint.terms) coefficients += std::abs(term.coefficient);
      scale.push_back(coefficients * extent + std::abs(constraint.value));
    }
    report_worst(phi, scale,
                 {kPositionTolerance, "the initial position violates it: Phi", "m^2", "m",
                  "the size of its terms"});
  }

  void check_velocity(const Model& model) const {
    std::vector<double> rate(static_cast<std::size_t>(model.constraints()));
    constraint_rate(model, model.initial_position(), model.initial_velocity(), rate);
    std::vector<double> row_norm(rate.size(), 0.0);
    std::vector<double> speed(rate.size(), 0.0);
    for (const JacobianEntry& entry : entries_) {
      const auto row = static_cast<std::size_t>(entry.row);
      row_norm[row] = std::hypot(row_norm[row], entry.value);
      speed[row] =
          std::hypot(speed[row], data_.initial_velocity[static_cast<std::size_t>(entry.col)]);
    }
    std::vector<double> scale;
    for (std::size_t i = 0; i < rate.size(); ++i) scale.push_back(row_norm[i] * speed[i]);
    report_worst(rate, scale,
                 {kVelocityTolerance, "the initial velocities violate it: Phi_q v", "m^2/s", "m/s",
                  "|Phi_q| |v|"});
  }

  void check_mobility(const Model& model) const {
    const int n = model.variables();
    const auto rank = jacobian_rank(model, model.initial_position());
    if (rank && *rank == n) {
      fail(
          fmt::format("the scene cannot move: its constraints hold all {} coordinates (rank {} at "
                      "the start), allowed is at least one degree of freedom",
                      n, *rank));
    }
    if (!rank && model.constraints() > n) {
      fail(fmt::format("found {} constraints on {} coordinates, allowed are at most as many",
                       model.constraints(), n));
    }
  }

  /// Fails with the constraint for which |value| / scale is worst, if that exceeds the tolerance.
  void report_worst(const std::vector<double>& value, const std::vector<double>& scale,
                    const Criterion& criterion) const {
    std::size_t worst = 0;
    double worst_ratio = 0.0;
    for (std::size_t i = 0; i < value.size(); ++i) {
      const double ratio = value[i] == 0.0 ? 0.0 : std::abs(value[i]) / scale[i];
      if (ratio <= worst_ratio) continue;
      worst = i;
      worst_ratio = ratio;
      if (std::isnan(ratio)) break;
    }
    if (worst_ratio <= criterion.tolerance) return;
    const bool is_dot = worst < data_.dot_constraints.size();
    fail(fmt::format("{}: {} = {:.6g} {}, allowed is at most {:g} of {}, which is {:.3g}",
                     constraint_name(worst), criterion.what, value[worst],
                     is_dot ? criterion.dot_unit : criterion.linear_unit, criterion.tolerance,
                     criterion.relative_to, scale[worst]));
  }

  [[nodiscard]] std::size_t row_of(std::size_t entry) const {
    return static_cast<std::size_t>(entries_[entry].row);
  }

  [[nodiscard]] double distance(int a, int b) const {
    const auto& x = data_.points[static_cast<std::size_t>(a)].position;
    const auto& y = data_.points[static_cast<std::size_t>(b)].position;
    return std::hypot(x[0] - y[0], x[1] - y[1], x[2] - y[2]);
  }

  [[nodiscard]] double largest_coordinate() const {
    double largest = 0.0;
    for (const Point& point : data_.points) {
      for (const double value : point.position) largest = std::max(largest, std::abs(value));
    }
    return largest;
  }

  const ModelData& data_;
  const std::string& where_;
  std::vector<std::size_t> owner_;
  std::vector<JacobianEntry> entries_;
};

}  // namespace

void check_scene(const ModelData& data, const std::string& where) { SceneCheck(data, where).run(); }

}  // namespace mbs
