// Position error against the closed form, energy, and the gaps of joints.
#include "judge.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace engines {
namespace {

struct Point {
  double x, y;
};

/// A point of a rod: side -1 is its pin, +1 its end.
Point point(const Mechanism& mechanism, const std::vector<RodState>& states, int rod, int side) {
  const auto i = static_cast<std::size_t>(rod);
  const double half = side * mechanism.rods[i].length / 2;
  return {states[i].x + half * states[i].cosine, states[i].y + half * states[i].sine};
}

std::string text(const char* format, double first, double second) {
  char buffer[200];
  std::snprintf(buffer, sizeof buffer, format, first, second);
  return buffer;
}

}  // namespace

Judge::Judge(const Mechanism& mechanism) : mechanism_(mechanism) {
  if (mechanism.four_bar_loops > 0) {
    exact_.emplace(mechanism.four_bar_loops);
    position_error_ = 0.0;
  }
  initial_energy_ = measure_energy(initial_states(mechanism));
  // As the harness does: a share of the work that gravity can do.
  double weight = 0.0, size = 0.0;
  for (const Rod& rod : mechanism.rods) {
    weight += rod.mass * kGravity;
    size = std::max(size, rod.anchor + 1.0);
  }
  energy_scale_ = std::max(energy_scale_, 1e-3 * weight * size);
}

bool Judge::judge_points(const std::vector<double>& points) {
  if (std::ranges::all_of(points, [](double one) { return std::isfinite(one); })) return true;
  return lose("diverged", "the state is not finite");
}

bool Judge::judge(double t, const std::vector<RodState>& states) {
  for (const RodState& s : states) {
    if (!std::isfinite(s.x + s.y + s.cosine + s.sine + s.vx + s.vy + s.rate))
      return lose("diverged", "the state is not finite");
  }
  judge_gaps(states);
  energy_difference_ =
      std::max(energy_difference_, std::abs(measure_energy(states) - initial_energy_));
  const bool conserved = energy_drift() <= kLost.energy_drift, together = gap_ <= kLost.gap;
  if (exact_) {
    q_.clear();
    for (int i = 0; i < mechanism_.points; ++i) {
      const Point b = point(mechanism_, states, i, +1);
      q_.insert(q_.end(), {b.x, b.y});
    }
    const double error = exact_->position_error(t, q_);
    position_error_ = std::max(*position_error_, error);
    if (!(error <= kLost.position_error)) {
      const double apart = exact_->distance_from_branch(q_);
      if (apart > error / 4 && conserved && together)
        return lose("wrong-branch", text("rods that are parallel differ by %.2e m", apart, 0));
      return lose("diverged", text("position error %.2e m against the exact solution (allowed %g)",
                                   error, kLost.position_error));
    }
  }
  if (!together)
    return lose("diverged", text("a joint is %.2e m apart (allowed %g)", gap_, kLost.gap));
  if (!conserved)
    return lose("diverged", text("energy drifted by %.2e of its scale (allowed %g)", energy_drift(),
                                 kLost.energy_drift));
  return true;
}

void Judge::conclude() {
  const auto add = [this](double value, double bound, const char* format) {
    if (!(value > bound)) return;  // a scene has no energy here: NaN
    status_ = "degraded";
    reason_ += (reason_.empty() ? "" : ", ") + text(format, value, bound);
  };
  add(position_error_.value_or(0.0), kAccurate.position_error, "position error %.1e m (ok to %g)");
  add(energy_drift(), kAccurate.energy_drift, "energy drift %.1e (ok to %g)");
  add(gap_, kAccurate.gap, "a joint is %.1e m apart (ok to %g)");
}

void Judge::judge_gaps(const std::vector<RodState>& states) {
  const auto compare = [this](Point a, Point b) {
    gap_ = std::max(gap_, std::hypot(a.x - b.x, a.y - b.y));
  };
  for (int i = 0; i < static_cast<int>(states.size()); ++i) {
    const Rod& rod = mechanism_.rods[static_cast<std::size_t>(i)];
    compare(point(mechanism_, states, i, -1),
            rod.parent < 0 ? Point{rod.anchor, 0.0} : point(mechanism_, states, rod.parent, +1));
  }
  for (const Loop& loop : mechanism_.loops)
    compare(point(mechanism_, states, loop.rod, +1), point(mechanism_, states, loop.other, +1));
}

double Judge::measure_energy(const std::vector<RodState>& states) {
  double kinetic = 0.0, potential = 0.0;
  for (std::size_t i = 0; i < states.size(); ++i) {
    const Rod& rod = mechanism_.rods[i];
    const RodState& s = states[i];
    kinetic += (rod.mass * (s.vx * s.vx + s.vy * s.vy) + rod.inertia() * s.rate * s.rate) / 2;
    potential += rod.mass * kGravity * s.y;
  }
  energy_scale_ = std::max(energy_scale_, kinetic);
  return kinetic + potential;
}

bool Judge::lose(const std::string& status, const std::string& reason) {
  status_ = status;
  reason_ = reason;
  return false;
}

}  // namespace engines
