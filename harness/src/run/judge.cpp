// The harness's own evaluation of a state; no implementation contributes to it.
#include "run/judge.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "model_math/extent.hpp"
#include "model_math/kinematics.hpp"
#include "model_math/known_motion.hpp"
#include "model_math/point_distance.hpp"
#include "model_math/turning.hpp"
#include "model_math/vector3.hpp"
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

bool is_finite(const State& state) {
  const auto finite = [](const std::vector<double>& values) {
    return std::ranges::all_of(values, [](double x) { return std::isfinite(x); });
  };
  return finite(state.q) && finite(state.v) && finite(state.a) && finite(state.lambda);
}

}  // namespace

double trapezoidal_error(const Model& model, const State& before, const State& after, double step) {
  return step * step / 12 * largest_point_distance(model, after.a, before.a);
}

double judged_length(const Model& model) {
  return std::min(extent(model.points()), fastest_turning(model).length);
}

Judge::Judge(const Scene& scene, const State& initial, double start)
    : scene_(&scene),
      phi_(static_cast<std::size_t>(scene.model.constraints())),
      phi_scale_(constraint_scales(scene.model)),
      conservative_(is_conservative(scene.model)) {
  const Model& model = scene.model;
  const double potential = potential_energy(model, start, initial.q);
  initial_energy_ = kinetic_energy(model, initial.v) + potential;
  double force = 0.0, in_springs = potential;
  for (std::size_t i = 0; i < initial.q.size(); ++i) {
    force += std::abs(model.force()[i]);
    in_springs += model.force()[i] * initial.q[i];
  }
  const double size = extent(model.points());
  energy_scale_ = 1e-3 * (force * size + std::max(in_springs, 0.0));
  double rest = 0.0;  // J, of a speed that is none; at rest without forces all else is rounding
  for (const double mass : mass_diagonal(model)) rest += mass * std::pow(1e-6 * size, 2) / 2;
  energy_scale_ = std::max(energy_scale_, rest);
  length_ = judged_length(model);
  for (const Torsion& torsion : torsions(model, start, initial.q)) twists_.push_back(torsion.twist);
  if (scene.four_bar_loops) {
    exact_.emplace(*scene.four_bar_loops);
    position_error_ = 0.0;
  }
  judge(start, initial);
}

std::string Judge::judge(double t, const State& state) {
  if (!is_finite(state)) {
    spoil();
    return "the state is not finite";
  }
  evaluate_constraints(scene_->model, t, state.q, phi_);
  double relative = 0.0;
  std::size_t worst = 0;
  for (std::size_t k = 0; k < phi_.size(); ++k) {
    // max() would drop a NaN that finite but huge coordinates make.
    if (!std::isfinite(phi_[k])) {
      spoil();
      return "the state is too large to be judged";
    }
    const double size = std::abs(phi_[k]);
    violation_ = std::max(violation_, size);
    if (size > relative * phi_scale_[k]) {
      relative = size / phi_scale_[k];
      worst = k;
    }
  }
  relative_violation_ = std::max(relative_violation_, relative);
  const std::string lost = judge_energy(t, state);
  if (!std::isfinite(energy_difference_)) return lost;
  if (exact_) {
    const double error = exact_->position_error(t, state.q);
    position_error_ = std::max(*position_error_, error);
    if (!(error <= bounds_.position_error)) {
      const double apart = exact_->distance_from_branch(state.q);
      // Late on the branch, rods are as parallel as they satisfy the constraints.
      off_branch_ = apart > error / 4 && lost.empty() && relative <= bounds_.constraint_violation;
      if (off_branch_) return fmt::format("rods that are parallel differ by {:.2e} m", apart);
      return fmt::format("position error {:.2e} m against the exact solution (allowed {:g})", error,
                         bounds_.position_error);
    }
  }
  if (!(relative <= bounds_.constraint_violation)) {
    return fmt::format("constraints violated by {:.2e} of their size (allowed {:g}), {} most",
                       relative, bounds_.constraint_violation,
                       row_name(scene_->model, static_cast<int>(worst)));
  }
  const std::string turned = judge_torsion(t, state);
  return turned.empty() ? lost : turned;
}

void Judge::add_local_error(double local, const State& judged, double step, long steps) {
  if (conservative_ && last_kinetic_ > 0.0) {
    const std::vector<double> rest(judged.v.size(), 0.0);
    local += step * largest_point_distance(scene_->model, judged.v, rest) *
             (std::sqrt(1 + last_energy_difference_ / last_kinetic_) - 1);
  }
  local_error_ += static_cast<double>(steps) * local;
}

std::string Judge::judge_torsion(double t, const State& state) {
  const auto now = torsions(scene_->model, t, state.q);
  for (std::size_t i = 0; i < now.size(); ++i) {
    const TorsionSpring& spring = scene_->model.torsion_springs()[i];
    if (!(now[i].tilt <= bounds_.tilt)) {
      return fmt::format(
          "{}: its axis is not perpendicular to what it turns, cosine {:.2e} "
          "(allowed {:g})",
          spring.name, now[i].tilt, bounds_.tilt);
    }
    twists_[i] += std::remainder(now[i].twist - twists_[i], 2 * std::numbers::pi);
    if (spring.stiffness > 0.0 && !(std::abs(twists_[i]) <= std::numbers::pi)) {
      return fmt::format(
          "{}: it is more than half a turn from its free angle, where its torque "
          "would change sign",
          spring.name);
    }
  }
  return "";
}

std::string Judge::judge_energy(double t, const State& state) {
  const double kinetic = kinetic_energy(scene_->model, state.v);
  const double difference =
      std::abs(kinetic + potential_energy(scene_->model, t, state.q) - initial_energy_);
  if (!std::isfinite(kinetic) || !std::isfinite(difference)) {
    spoil();
    return "the state is too large to be judged";
  }
  if (!conservative_) return "";
  energy_scale_ = std::max(energy_scale_, kinetic);
  last_kinetic_ = kinetic;
  last_energy_difference_ = difference;
  energy_difference_ = std::max(energy_difference_, difference);
  if (*energy_drift_max() <= bounds_.energy_drift) return "";
  return fmt::format("energy drifted by {:.2e} of its scale (allowed {:g})", *energy_drift_max(),
                     bounds_.energy_drift);
}

void Judge::spoil() {
  violation_ = relative_violation_ = energy_difference_ = std::numeric_limits<double>::infinity();
  if (exact_) position_error_ = std::numeric_limits<double>::infinity();
}

std::string Judge::degradation() const {
  constexpr AccurateBounds accurate;
  std::vector<std::string> beyond;
  const auto add = [&beyond](double value, double bound, const char* what) {
    if (!(value <= bound))
      beyond.push_back(fmt::format("{} {:.1e} (ok to {:g})", what, value, bound));
  };
  add(position_error_.value_or(0.0), accurate.position_error, "position error");
  add(energy_drift_max().value_or(0.0), accurate.energy_drift, "energy drift");
  add(relative_violation_, accurate.constraint_violation, "constraint violation");
  return fmt::format("{}", fmt::join(beyond, ", "));
}

std::optional<double> Judge::energy_drift_max() const {
  if (!conservative_) return std::nullopt;
  return energy_scale_ > 0.0 ? energy_difference_ / energy_scale_ : energy_difference_;
}

}  // namespace mbs
