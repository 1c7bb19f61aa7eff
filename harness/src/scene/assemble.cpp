// The start of a scene: positions and velocities moved onto the constraints, within bounds.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "model_math/consistency.hpp"
#include "model_math/extent.hpp"
#include "printable.hpp"
#include "scene/row_names.hpp"
#include "scene/scene.hpp"
#include "usage_error.hpp"

namespace mbs {
namespace {

/// Ratio up to which a start counts as assembled: far above rounding, far below any reading error.
constexpr double kAssembled = 1e-10;
/// Largest change of a given velocity, as a share of the largest given one.
constexpr double kLargestVelocityChange = 0.1;

double change_of(const Point& point, int dimension, std::span<const double> from,
                 std::span<const double> to) {
  double change = 0.0;
  for (int axis = 0; axis < dimension; ++axis) {
    const auto i = static_cast<std::size_t>(point.offset + axis);
    change = std::hypot(change, to[i] - from[i]);
  }
  return change;
}

class Assembly {
 public:
  Assembly(SceneData& data, const std::string& where)
      : data_(data),
        where_(where),
        model_(data.model),
        start_(model_.initial_position().begin(), model_.initial_position().end()),
        given_(model_.initial_velocity().begin(), model_.initial_velocity().end()),
        q_(start_),
        v_(given_) {}

  void run() {
    data_.assembly = {};
    if (model_.constraints() == 0) return;
    assemble_positions();
    assemble_velocities();
    write_back();
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw UsageError(fmt::format("{}: {}", printable(where_), what));
  }

  void assemble_positions() {
    const Violation before = position_violation(model_, 0.0, start_);
    const Violation rest = move_onto_constraints(model_, 0.0, q_);
    if (!(rest.ratio <= kAssembled)) {
      fail(
          fmt::format("the start cannot be assembled: what remains is worst at {}; its constraints "
                      "contradict each other or the positions are too far off",
                      describe_violation(model_, rest)));
    }
    // A vector's change is that of a point at its end if it were as long as the scene.
    const double scene_extent = extent(model_.points());
    double largest = 0.0;
    std::string where;
    for (const Point& point : model_.points()) {
      if (point.is_fixed()) continue;
      const double change = change_of(point, model_.dimension(), start_, q_);
      const double counted = point.is_vector ? change * scene_extent : change;
      if (counted > largest) {
        largest = counted;
        where = point.name;
      }
      if (!point.is_vector && change > data_.assembly.position_correction) {
        data_.assembly.position_correction = change;
        data_.assembly.point = point.name;
      }
    }
    if (largest <= data_.largest_correction || largest == 0.0) return;
    fail(fmt::format(
        "the start is too far from its constraints: {} would move by {:.3g} m, allowed "
        "is {:.3g} m (assembly.largest_correction); worst is {}",
        in_quotes(where), largest, data_.largest_correction, describe_violation(model_, before)));
  }

  /// Velocities given (not zero) stay if the others can follow; else all change.
  void assemble_velocities() {
    const Violation before = velocity_violation(model_, 0.0, q_, v_);
    if (before.ratio <= kMet) return;
    std::vector<bool> held(v_.size(), false);
    for (const Point& point : model_.points()) {
      if (!point.is_fixed() && speed(point, given_) > 0.0) {
        std::fill_n(held.begin() + point.offset, model_.dimension(), true);
      }
    }
    const bool any_held = std::ranges::find(held, true) != held.end();
    Violation rest = before;
    if (any_held) rest = make_consistent(model_, 0.0, q_, v_, held);
    if (!(rest.ratio <= kMet)) rest = make_consistent(model_, 0.0, q_, v_);
    if (!(rest.ratio <= kAssembled)) {
      fail(
          fmt::format("the velocities cannot be made consistent: the start is a singular position "
                      "or its drivers contradict the constraints; what remains is {:.3g} {} at {}",
                      rest.value, rate_unit(model_, rest.row), row_name(model_, rest.row)));
    }
    check_velocity_change(before);
  }

  void check_velocity_change(const Violation& before) {
    double fastest = 0.0;
    for (const Point& point : model_.points()) {
      if (!point.is_fixed()) fastest = std::max(fastest, speed(point, given_));
    }
    for (const Point& point : model_.points()) {
      if (point.is_fixed()) continue;
      const double change = change_of(point, model_.dimension(), given_, v_);
      data_.assembly.velocity_correction = std::max(data_.assembly.velocity_correction, change);
      if (speed(point, given_) == 0.0 || change <= kLargestVelocityChange * fastest) continue;
      fail(fmt::format(
          "the velocities contradict the constraints: that of {}, {:.3g} m/s, would "
          "change by {:.3g} m/s, allowed is {:.3g} m/s, a tenth of the largest given; "
          "worst is {}, whose Phi changes at {:.3g} {}",
          in_quotes(point.name), speed(point, given_), change, kLargestVelocityChange * fastest,
          row_name(model_, before.row), before.value, rate_unit(model_, before.row)));
    }
  }

  [[nodiscard]] double speed(const Point& point, std::span<const double> v) const {
    double result = 0.0;
    for (int axis = 0; axis < model_.dimension(); ++axis) {
      result = std::hypot(result, v[static_cast<std::size_t>(point.offset + axis)]);
    }
    return result;
  }

  void write_back() {
    for (Point& point : data_.model.points) {
      if (point.is_fixed()) continue;
      std::copy_n(q_.begin() + point.offset, model_.dimension(), point.position.begin());
    }
    data_.model.initial_velocity = v_;
  }

  SceneData& data_;
  const std::string& where_;
  Model model_;
  std::vector<double> start_, given_;  // q and v as given
  std::vector<double> q_, v_;
};

}  // namespace

void assemble_start(SceneData& data, const std::string& where) { Assembly(data, where).run(); }

}  // namespace mbs
