// The harness's own evaluation of a state; no implementation contributes to it.
#include "run/judge.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>

#include "model_math/connected_parts.hpp"
#include "model_math/extent.hpp"
#include "model_math/kinematics.hpp"
#include "model_math/known_motion.hpp"
#include "model_math/turning.hpp"
#include "model_math/vector3.hpp"
#include "printable.hpp"
#include "scene/row_names.hpp"

namespace mbs {
namespace {

/// Largest entry of B, at least of a dot constraint.
double largest_factor(const DotConstraint&) { return 1.0; }
double largest_factor(const BilinearConstraint& c) {
  double largest = 0.0;
  for (const auto& row : c.B) {
    for (const double entry : row) largest = std::max(largest, std::abs(entry));
  }
  return largest;
}

/// What each constraint's |Phi| is small against: the product of the two lengths that it relates,
/// or its value if that is more, or the extent times the largest coefficient if linear.
std::vector<double> constraint_scales(const Model& model) {
  const double scene_extent = extent(model.points());
  const auto known = KnownMotion(model, 0.0).values();
  std::vector<double> scales;
  const auto length = [points = model.points()](int a, int b) {
    const Vector3 d =
        points[static_cast<std::size_t>(a)].position - points[static_cast<std::size_t>(b)].position;
    return std::hypot(d[0], d[1], d[2]);
  };
  const auto add = [&](double scale) {
    scale = std::max(scale, std::abs(known[scales.size()].value));
    scales.push_back(scale > 0.0 ? scale : scene_extent * scene_extent);
  };
  const auto add_quadratic = [&](const auto& c) {
    add(largest_factor(c) * length(c.a, c.b) * length(c.c, c.d));
  };
  for (const DotConstraint& c : model.dot_constraints()) add_quadratic(c);
  for (const BilinearConstraint& c : model.bilinear_constraints()) add_quadratic(c);
  for (const LinearConstraint& c : model.linear_constraints()) {
    double coefficient = 0.0;
    for (const auto& term : c.terms)
      coefficient = std::max(coefficient, std::abs(term.coefficient));
    add(coefficient * scene_extent);
  }
  return scales;
}

/// By the exponents, as integers: several numbers at a time, unlike std::isfinite. One more carries
/// into the sign where all its bits are set. (A largest one AVX2 does not have.)
bool is_finite(const std::vector<double>& values) {
  constexpr auto kExponent = std::bit_cast<std::uint64_t>(std::numeric_limits<double>::infinity());
  constexpr std::uint64_t kOne = std::uint64_t{1} << 52U;
  std::uint64_t carried = 0;
  for (const double x : values) carried |= (std::bit_cast<std::uint64_t>(x) & kExponent) + kOne;
  return carried >> 63U == 0;
}

bool is_finite(const State& state) {
  return is_finite(state.q) && is_finite(state.v) && is_finite(state.a) && is_finite(state.lambda);
}

}  // namespace

double judged_length(const Model& model) {
  return std::min(extent(model.points()), fastest_turning(model).length);
}

Judge::Judge(const Scene& scene, const State& initial, double start)
    : scene_(&scene),
      constraints_(scene.model),
      phi_(static_cast<std::size_t>(scene.model.constraints())),
      phi_scale_(constraint_scales(scene.model)),
      conservative_(is_conservative(scene.model)),
      carriage_(EvenCarriage::of(scene.model)),
      frame_velocity_(carriage_ ? carriage_->velocity() : std::vector<double>(initial.v.size())) {
  const Model& model = scene.model;
  conservative_ = conservative_ || carriage_;
  if (carriage_) move_with_feet(start, initial);
  const double potential = carriage_ ? potential_energy(model, 0.0, moved_q_)
                                     : potential_energy(model, start, initial.q);
  const double size = extent(model.points());
  so_far_.energy.reference = kinetic_energy(model, velocity(initial)) + potential;
  so_far_.energy.scale = least_energy_scale(model, initial.q, potential, size);
  if (!conservative_ || (!carriage_ && ConnectedParts(model).undriven().size() > 1)) {
    parts_.emplace(model, initial, start, size);
    so_far_.parts = parts_->start();
  }
  length_ = judged_length(model);
  for (const Torsion& torsion : torsions(model, start, initial.q))
    so_far_.twists.push_back(torsion.twist);
  if (scene.four_bar_loops) {
    exact_.emplace(*scene.four_bar_loops);
    so_far_.position_error = 0.0;
  }
  judge(start, initial);
}

std::string Judge::judge(double t, const State& state) {
  if (!is_finite(state)) {
    spoil();
    return "the state is not finite";
  }
  constraints_.evaluate(t, state.q, phi_);
  if (!is_finite(phi_)) {  // huge coordinates
    spoil();
    return "the state is too large to be judged";
  }
  double violation = 0.0, relative = 0.0;  // without branches, which would be random
  for (std::size_t k = 0; k < phi_.size(); ++k) {
    violation = std::max(violation, std::abs(phi_[k]));
    relative = std::max(relative, std::abs(phi_[k]) / phi_scale_[k]);
  }
  const bool holds = relative <= bounds_.constraint_violation;
  so_far_.violation = std::max(so_far_.violation, violation);
  if (relative > so_far_.relative_violation) {
    so_far_.relative_violation = relative;
    if (relative > AccurateBounds{}.constraint_violation) {
      so_far_.most_violated = most_violated_row();
    }
  }
  const std::string lost = judge_energy(t, state);
  if (!std::isfinite(so_far_.energy.farthest)) return lost;
  if (exact_) {
    const double error = exact_->position_error(t, state.q);
    so_far_.position_error = std::max(*so_far_.position_error, error);
    if (!(error <= bounds_.position_error)) {
      const double apart = exact_->distance_from_branch(state.q);
      // Late on the branch, rods are as parallel as they satisfy the constraints.
      so_far_.off_branch = apart > error / 4 && lost.empty() && holds;
      if (so_far_.off_branch)
        return fmt::format("rods that are parallel differ by {:.2e} m", apart);
      return fmt::format("position error {:.2e} m against the exact solution (allowed {:g})", error,
                         bounds_.position_error);
    }
  }
  if (!holds) {
    return fmt::format("constraints violated by {:.2e} of their size (allowed {:g}), {} most",
                       relative, bounds_.constraint_violation,
                       row_name(scene_->model, most_violated_row()));
  }
  const std::string turned = judge_torsion(t, state);
  return turned.empty() ? lost : turned;
}

int Judge::most_violated_row() const {
  std::size_t most = 0;
  const auto share = [this](std::size_t k) { return std::abs(phi_[k]) / phi_scale_[k]; };
  for (std::size_t k = 1; k < phi_.size(); ++k) {
    if (share(k) > share(most)) most = k;
  }
  return static_cast<int>(most);
}

void Judge::add_time(double time, double speed) {
  for (auto& part : so_far_.parts) part.add(time);
  so_far_.energy.speed = speed;
  if (conservative_) so_far_.energy.add(time);
}

double Judge::ahead_max() const {
  double ahead = so_far_.energy.farthest_ahead;
  for (const auto& part : so_far_.parts) ahead = std::max(ahead, part.farthest_ahead);
  return ahead;
}

void Judge::add_balance(double excess, double work, long steps) {
  so_far_.excess += static_cast<double>(steps) * excess;
  so_far_.work += static_cast<double>(steps) * work;
  const double share = std::abs(so_far_.excess) / std::max(so_far_.energy.scale, so_far_.work);
  if (!(share <= so_far_.imbalance.value_or(0.0))) so_far_.imbalance = share;
  if (!so_far_.imbalance) so_far_.imbalance = 0.0;
}

std::string Judge::judge_torsion(double t, const State& state) {
  if (so_far_.twists.empty()) return "";  // there are none
  const auto now = torsions(scene_->model, t, state.q);
  for (std::size_t i = 0; i < now.size(); ++i) {
    if (!(now[i].tilt <= bounds_.tilt)) {
      return fmt::format(
          "{}: its axis is not perpendicular to what it turns, cosine {:.2e} "
          "(allowed {:g})",
          now[i].name, now[i].tilt, bounds_.tilt);
    }
    so_far_.twists[i] += std::remainder(now[i].twist - so_far_.twists[i], 2 * std::numbers::pi);
    if (!now[i].can_turn_on && !(std::abs(so_far_.twists[i]) <= std::numbers::pi)) {
      const bool is_spring = i < scene_->model.torsion_springs().size();
      return fmt::format("{}: it is more than half a turn from {}", now[i].name,
                         is_spring ? "its free angle, where its torque would change sign"
                                   : "the angle 0, where its table would begin again");
    }
  }
  return "";
}

void Judge::move_with_feet(double t, const State& state) {
  moved_q_ = state.q;
  moved_v_ = state.v;
  for (std::size_t i = 0; i < moved_q_.size(); ++i) {
    moved_q_[i] -= frame_velocity_[i] * t;
    moved_v_[i] -= frame_velocity_[i];
  }
}

std::string Judge::judge_energy(double t, const State& state) {
  if (carriage_ && !carriage_->holds(scene_->model, t)) {
    carriage_.reset();
    conservative_ = false;
  }
  if (carriage_) move_with_feet(t, state);
  // The shorter sum first, so that the processor begins the other one while it waits for it.
  const double potential = !conservative_ ? 0.0
                           : carriage_    ? potential_energy(scene_->model, 0.0, moved_q_)
                                          : potential_energy(scene_->model, t, state.q);
  const double kinetic = kinetic_energy(scene_->model, velocity(state));
  if (!std::isfinite(kinetic) || !std::isfinite(potential)) {
    spoil();
    return "the state is too large to be judged";
  }
  if (conservative_) {
    so_far_.energy.judge(kinetic, potential, false);
    if (!(*energy_drift_max() <= bounds_.energy_drift))
      return fmt::format("energy drifted by {:.2e} of its scale (allowed {:g})",
                         *energy_drift_max(), bounds_.energy_drift);
  } else {
    so_far_.energy.scale = std::max(so_far_.energy.scale, kinetic);
  }
  if (parts_) parts_->judge(t, state, so_far_.parts);
  if (part_drift() <= bounds_.energy_drift) return "";
  return fmt::format("energy of a part drifted by {:.2e} of its scale (allowed {:g})", part_drift(),
                     bounds_.energy_drift);
}

double Judge::part_drift() const {
  double largest = 0.0;
  for (const auto& part : so_far_.parts) largest = std::max(largest, part.drift());
  return largest;
}

void Judge::spoil() {
  so_far_.violation = so_far_.relative_violation = so_far_.energy.farthest =
      std::numeric_limits<double>::infinity();
  if (exact_) so_far_.position_error = std::numeric_limits<double>::infinity();
}

std::array<Judge::Bounded, 5> Judge::bounded() const {
  constexpr AccurateBounds accurate;
  return {{{so_far_.position_error.value_or(0.0), accurate.position_error, "position error"},
           {energy_drift_max().value_or(0.0), accurate.energy_drift, "energy drift"},
           {part_drift(), accurate.energy_drift, "energy drift of a part", &Judge::drifting_part},
           {so_far_.imbalance.value_or(0.0), accurate.energy_drift,
            "energy off the work of dampers, drivers and forces by"},
           {so_far_.relative_violation, accurate.constraint_violation, "constraint violation",
            &Judge::violated_row}}};
}

std::string Judge::drifting_part() const {
  const auto part = std::ranges::max_element(so_far_.parts, {}, &EnergyFigures::drift);
  const auto place = static_cast<std::size_t>(part - so_far_.parts.begin());
  return ", that of " + printable(parts_->name(place), 60);
}

std::string Judge::violated_row() const {
  return ", most of " + row_name(scene_->model, so_far_.most_violated);
}

bool Judge::is_degraded() const { return std::ranges::any_of(bounded(), &Bounded::is_beyond); }

std::string Judge::degradation() const {
  std::vector<std::string> beyond;
  for (const Bounded& one : bounded()) {
    if (!one.is_beyond()) continue;
    beyond.push_back(fmt::format("{} {:.1e} (ok to {:g}){}", one.what, one.value, one.bound,
                                 one.where != nullptr ? (this->*one.where)() : ""));
  }
  return fmt::format("{}", fmt::join(beyond, ", "));
}

std::optional<double> Judge::energy_drift_max() const {
  if (!conservative_) return std::nullopt;
  return so_far_.energy.drift();
}

}  // namespace mbs
