// The start of a scene: positions and velocities moved onto the constraints, within bounds.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "model_math/consistency.hpp"
#include "model_math/extent.hpp"
#include "model_math/known_motion.hpp"
#include "model_math/vector3.hpp"
#include "printable.hpp"
#include "scene/row_names.hpp"
#include "scene/not_assembled.hpp"
#include "scene/scene.hpp"
#include "usage_error.hpp"

namespace mbs {
namespace {

/// Ratio up to which a start counts as assembled: far above rounding, far below any reading error.
constexpr double kAssembled = 1e-10;
/// Largest change of a given velocity, as a share of the largest given one.
constexpr double kLargestVelocityChange = 0.1;

/// A point or vector of the scene with a velocity or position before and after.
struct Change {
  std::string name, path;
  bool is_vector = false;
  Vector3 from{}, to{};

  [[nodiscard]] double size() const { return norm(to - from); }
};

class Assembly {
 public:
  Assembly(SceneData& data, const std::string& where)
      : data_(data),
        where_(where),
        model_(data.model),
        start_(model_.initial_position().begin(), model_.initial_position().end()),
        given_(model_.initial_velocity().begin(), model_.initial_velocity().end()),
        q_(start_),
        v_(given_),
        known_(model_, 0.0) {}

  void run() {
    data_.assembly = {};
    assemble_positions();
    assemble_velocities();
    write_back();
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw NotAssembled(fmt::format("{}: {}", printable(where_), what));
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
    for (const Change& change : position_changes()) {
      const double counted = change.is_vector ? change.size() * scene_extent : change.size();
      if (counted > largest) {
        largest = counted;
        where = change.name;
      }
      if (!change.is_vector && counted > data_.assembly.position_correction) {
        data_.assembly.position_correction = counted;
        data_.assembly.point = change.name;
      }
    }
    if (largest <= data_.largest_correction || largest == 0.0) return;
    fail(fmt::format(
        "the start is too far from its constraints: {} would move by {:.3g} m, allowed "
        "is {:.3g} m (assembly.largest_correction){}",
        in_quotes(where), largest, data_.largest_correction,
        before.ratio <= kMet ? "" : "; worst is " + describe_violation(model_, before)));
  }

  /// Of the coordinates, and of what the file says of points that are computed from them.
  [[nodiscard]] std::vector<Change> position_changes() const {
    std::vector<Change> changes = changes_of(start_, q_);
    for (const GivenMarker& given : data_.given_markers) {
      if (!given.position) continue;
      changes.push_back({marker(given).name, given.path, given.is_vector, *given.position,
                         place(marker(given), q_, &KnownMotion::position)});
    }
    return changes;
  }
  [[nodiscard]] std::vector<Change> velocity_changes() const {
    std::vector<Change> changes = changes_of(given_, v_);
    for (const GivenMarker& given : data_.given_markers) {
      if (!given.velocity) continue;
      changes.push_back({marker(given).name, given.path + ".velocity", given.is_vector,
                         *given.velocity, place(marker(given), v_, &KnownMotion::velocity)});
    }
    return changes;
  }

  [[nodiscard]] std::vector<Change> changes_of(const std::vector<double>& from,
                                               const std::vector<double>& to) const {
    std::vector<Change> changes;
    for (std::size_t i = 0; i < model_.points().size(); ++i) {
      const Point& point = model_.points()[i];
      if (point.is_fixed()) continue;
      const std::string path = i < data_.velocity_paths.size() ? data_.velocity_paths[i] : "";
      changes.push_back({point.name, path, point.is_vector, part(point, from), part(point, to)});
    }
    return changes;
  }

  [[nodiscard]] Vector3 part(const Point& point, const std::vector<double>& x) const {
    Vector3 result{};
    std::copy_n(x.begin() + point.offset, model_.dimension(), result.begin());
    return result;
  }
  [[nodiscard]] const Marker& marker(const GivenMarker& given) const {
    return data_.elements.markers[static_cast<std::size_t>(given.marker)];
  }
  /// Position or velocity of a marker, from those of all coordinates and the known motion.
  [[nodiscard]] Vector3 place(const Marker& marker, const std::vector<double>& x,
                              Vector3 (KnownMotion::*known)(int) const) const {
    Vector3 result{};
    for (const Marker::Part& of : marker.parts) {
      const Point& point = model_.points()[static_cast<std::size_t>(of.point)];
      const Vector3 r = point.is_fixed() ? (known_.*known)(of.point) : part(point, x);
      result = result + multiply(of.matrix, r);
    }
    return result;
  }

  /// Velocities given (not zero) stay if the others can follow; else they change last.
  void assemble_velocities() {
    const Violation before = velocity_violation(model_, 0.0, q_, v_);
    if (before.ratio > kMet) make_velocities_consistent();
    check_velocity_change(before);
  }

  void make_velocities_consistent() {
    constexpr double kHeld = std::numeric_limits<double>::infinity();
    constexpr double kFirm = 1e3;  // a millionth of the change that the others make
    std::vector<double> weights(v_.size(), 1.0);
    for (const Point& point : model_.points()) {
      if (!point.is_fixed() && norm(part(point, given_)) > 0.0) {
        std::fill_n(weights.begin() + point.offset, model_.dimension(), kHeld);
      }
    }
    Violation rest{std::numeric_limits<double>::infinity()};
    if (std::ranges::find(weights, kHeld) != weights.end()) {
      rest = make_consistent(model_, 0.0, q_, v_, weights);
    }
    if (!(rest.ratio <= kAssembled)) v_ = given_;  // else only rounding is left to remove
    if (!(rest.ratio <= kMet)) {
      std::ranges::replace(weights, kHeld, kFirm);
      rest = make_consistent(model_, 0.0, q_, v_, weights);
    }
    if (rest.ratio <= kAssembled) return;
    fail(
        fmt::format("the velocities cannot be made consistent: the start is a singular position "
                    "or its drivers contradict the constraints; what remains is {:.3g} {} at {}",
                    rest.value, rate_unit(model_, rest.row), row_name(model_, rest.row)));
  }

  void check_velocity_change(const Violation& before) {
    const std::vector<Change> changes = velocity_changes();
    double fastest = 0.0;
    for (const Change& change : changes) fastest = std::max(fastest, norm(change.from));
    for (const Change& change : changes) {
      data_.assembly.velocity_correction =
          std::max(data_.assembly.velocity_correction, change.size());
      if (norm(change.from) == 0.0 || change.size() <= kLargestVelocityChange * fastest) continue;
      fail(fmt::format(
          "{}{}the velocities contradict the constraints: that of {}, {:.3g} m/s, would "
          "change by {:.3g} m/s, allowed is {:.3g} m/s, a tenth of the largest given{}",
          change.path, change.path.empty() ? "" : ": ", in_quotes(change.name), norm(change.from),
          change.size(), kLargestVelocityChange * fastest,
          before.ratio <= kMet ? ""
                               : fmt::format("; worst is {}, whose Phi changes at {:.3g} {}",
                                             row_name(model_, before.row), before.value,
                                             rate_unit(model_, before.row))));
    }
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
  KnownMotion known_;
};

}  // namespace

void assemble_start(SceneData& data, const std::string& where) { Assembly(data, where).run(); }

}  // namespace mbs
