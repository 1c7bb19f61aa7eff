// Gauss-Newton on Phi(q, t) = 0, and the linear Phi_q v = -Phi_t.
#include "model_math/consistency.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "model_math/kinematics.hpp"
#include "model_math/known_motion.hpp"
#include "model_math/largest.hpp"
#include "model_math/least_change.hpp"
#include "model_math/vector3.hpp"

namespace mbs {
namespace {

constexpr double kReached = 1e-15;  // no better ratio is worth a step

double factor_norm(const BilinearConstraint& c) {
  double sum = 0.0;
  for (const auto& row : c.B) {
    for (const double entry : row) sum = std::hypot(sum, entry);
  }
  return sum;
}
double factor_norm(const DotConstraint&) { return 1.0; }

/// Positions of the points, fixed and driven ones included.
std::vector<Vector3> positions(const Model& model, const KnownMotion& known,
                               std::span<const double> q) {
  std::vector<Vector3> result(model.points().size());
  for (std::size_t i = 0; i < result.size(); ++i) {
    const Point& point = model.points()[i];
    if (point.is_fixed()) {
      result[i] = known.position(static_cast<int>(i));
    } else {
      std::copy_n(q.begin() + point.offset, model.dimension(), result[i].begin());
    }
  }
  return result;
}

double largest_position(const Model& model, const std::vector<Vector3>& positions) {
  double largest = 0.0;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    if (!model.points()[i].is_vector) largest = std::max(largest, norm(positions[i]));
  }
  return largest;
}

/// The size of each constraint's terms at q, see position_violation().
std::vector<double> sizes_of_terms(const Model& model, double t, std::span<const double> q) {
  const KnownMotion known(model, t);
  const std::vector<Vector3> r = positions(model, known, q);
  const double largest = largest_position(model, r);
  std::vector<double> result;
  result.reserve(known.values().size());
  const auto value = [&] { return std::abs(known.values()[result.size()].value); };
  const auto length = [&](int a, int b) {
    return norm(r[static_cast<std::size_t>(a)] - r[static_cast<std::size_t>(b)]);
  };
  const auto add_quadratic = [&](const auto& c) {
    const double u = length(c.a, c.b), w = length(c.c, c.d);
    result.push_back(factor_norm(c) * (u * w + (u + w) * largest) + value());
  };
  for (const DotConstraint& c : model.dot_constraints()) add_quadratic(c);
  for (const BilinearConstraint& c : model.bilinear_constraints()) add_quadratic(c);
  for (const LinearConstraint& c : model.linear_constraints()) {
    double coefficients = 0.0;
    for (const auto& term : c.terms) coefficients += std::abs(term.coefficient);
    result.push_back(coefficients * largest + value());
  }
  return result;
}

/// The size of each rate's terms where no velocity exceeds `fastest`, see velocity_violation().
std::vector<double> sizes_of_rates(const Model& model, double t, std::span<const double> q,
                                   double fastest) {
  const std::vector<double> zero(q.size());
  std::vector<double> sizes(static_cast<std::size_t>(model.constraints()));
  constraint_rate(model, t, q, zero, sizes);  // Phi_t
  const std::size_t quadratic = sizes.size() - model.linear_constraints().size();
  const double largest = largest_position(model, positions(model, KnownMotion(model, t), q));
  for (std::size_t k = 0; k < sizes.size(); ++k) {
    sizes[k] = std::abs(sizes[k]) + (k < quadratic ? largest * fastest : 0.0);
  }
  for (const JacobianEntry& entry : jacobian(model, t, q)) {
    sizes[static_cast<std::size_t>(entry.row)] += std::abs(entry.value) * fastest;
  }
  return sizes;
}

/// The worst of `values` against `sizes`.
Violation worst_of(const std::vector<double>& values, const std::vector<double>& sizes) {
  Violation worst;
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (values[k] == 0.0) continue;
    double ratio = std::abs(values[k]) / std::max(sizes[k], std::numeric_limits<double>::min());
    if (!std::isfinite(ratio)) ratio = std::numeric_limits<double>::infinity();
    if (ratio > worst.ratio) worst = {ratio, static_cast<int>(k), values[k]};
  }
  return worst;
}

std::vector<double> constraints_at(const Model& model, double t, std::span<const double> q) {
  std::vector<double> phi(static_cast<std::size_t>(model.constraints()));
  evaluate_constraints(model, t, q, phi);
  return phi;
}

std::vector<double> rates_at(const Model& model, double t, std::span<const double> q,
                             std::span<const double> v) {
  std::vector<double> rate(static_cast<std::size_t>(model.constraints()));
  constraint_rate(model, t, q, v, rate);
  return rate;
}

/// Sum of squared ratios: what a Gauss-Newton step must reduce. Not finite if anything is not.
double merit(const std::vector<double>& phi, const std::vector<double>& sizes) {
  double sum = 0.0;
  for (std::size_t k = 0; k < phi.size(); ++k) {
    const double ratio = phi[k] / std::max(sizes[k], std::numeric_limits<double>::min());
    sum += ratio * ratio;
  }
  return sum;
}

std::vector<double> negative(std::vector<double> x) {
  for (double& value : x) value = -value;
  return x;
}

std::vector<double> sum(const std::vector<double>& x, double factor, const std::vector<double>& y) {
  std::vector<double> result(x);
  for (std::size_t i = 0; i < x.size(); ++i) result[i] += factor * y[i];
  return result;
}

/// Gauss-Newton steps that are damped where they would not help [Levenberg, 1944].
class Approach {
 public:
  Approach(const Model& model, double t, const std::vector<double>& sizes)
      : model_(model), t_(t), sizes_(sizes) {}

  /// One step of q and Phi(q, t), whose worst ratio is `ratio`. False, and both unchanged, if no
  /// step helps. Once the constraints are met what is left is rounding, which a plain step may
  /// still reduce; damping would only cost time.
  bool step(std::vector<double>& q, std::vector<double>& phi, double ratio) {
    constexpr double kFirst = 1e-4, kLast = 1e4;  // damping, where there is any
    constexpr double kNear = 1e-3;  // from here on plain steps do not lead to another solution
    const bool is_met = ratio <= kMet;
    if (is_met) damping_ = 0.0;
    const double before = merit(phi, sizes_);
    if (damping_ == 0.0 && run_plain(q, phi, before, ratio < kNear ? 8 : 1)) return true;
    if (is_met) return false;
    for (damping_ = std::max(kFirst, damping_); damping_ <= kLast; damping_ *= 10.0) {
      const LeastChange least(model_, t_, q, {}, damping_);
      std::vector<double> trial = sum(q, 1.0, least.solve(negative(phi)));
      std::vector<double> trial_phi = constraints_at(model_, t_, trial);
      if (!(merit(trial_phi, sizes_) < before)) continue;  // nor does NaN help
      damping_ = damping_ > kFirst ? damping_ / 10.0 : 0.0;
      q = std::move(trial);
      phi = std::move(trial_phi);
      return true;
    }
    return false;
  }

 private:
  /// Up to `steps` plain steps, which may make things worse before they converge quadratically, as
  /// long chains do. Goes to the first of them that is better than the start of the run.
  bool run_plain(std::vector<double>& q, std::vector<double>& phi, double before, int steps) {
    std::vector<double> trial = q, trial_phi = phi;
    for (int i = 0; i < steps; ++i) {
      trial = sum(trial, 1.0, LeastChange(model_, t_, trial, {}, 0.0).solve(negative(trial_phi)));
      trial_phi = constraints_at(model_, t_, trial);
      const double after = merit(trial_phi, sizes_);
      if (!std::isfinite(after)) return false;
      if (after < 0.9 * before) {
        q = std::move(trial);
        phi = std::move(trial_phi);
        return true;
      }
    }
    return false;
  }

  const Model& model_;
  double t_;
  const std::vector<double>& sizes_;
  double damping_ = 0.0;
};

}  // namespace

Violation position_violation(const Model& model, double t, std::span<const double> q) {
  return worst_of(constraints_at(model, t, q), sizes_of_terms(model, t, q));
}

Violation velocity_violation(const Model& model, double t, std::span<const double> q,
                             std::span<const double> v) {
  return worst_of(rates_at(model, t, q, v), sizes_of_rates(model, t, q, largest_of(v)));
}

Violation move_onto_constraints(const Model& model, double t, std::vector<double>& q) {
  // Those of the start throughout, so that nothing counts as small because something else grew.
  const std::vector<double> sizes = sizes_of_terms(model, t, q);
  std::vector<double> phi = constraints_at(model, t, q);
  Violation rest = worst_of(phi, sizes);
  if (rest.ratio <= kMet || !std::isfinite(rest.ratio)) return rest;
  // Towards a singular position the steps halve the distance only: 60 of them reach rounding.
  constexpr int kMostSteps = 100;
  Approach approach(model, t, sizes);
  for (int i = 0; i < kMostSteps && rest.ratio > kReached; ++i) {
    if (!approach.step(q, phi, rest.ratio)) break;
    rest = worst_of(phi, sizes);
  }
  return rest;
}

Violation make_consistent(const Model& model, double t, std::span<const double> q,
                          std::vector<double>& v, const std::vector<double>& weights) {
  const double given = largest_of(v);  // v may have to vanish: what is left is then rounding of it
  std::vector<double> rates = rates_at(model, t, q, v);
  Violation rest = worst_of(rates, sizes_of_rates(model, t, q, given));
  if (rest.ratio <= kMet || !std::isfinite(rest.ratio)) return rest;
  const LeastChange least(model, t, q, weights);
  constexpr int kMostRounds = 5;  // the first solves, the others remove the rounding of the first
  for (int i = 0; i < kMostRounds && rest.ratio > kReached; ++i) {
    const std::vector<double> next = sum(v, 1.0, least.solve(negative(rates)));
    std::vector<double> next_rates = rates_at(model, t, q, next);
    const double fastest = std::max(given, largest_of(next));
    const Violation after = worst_of(next_rates, sizes_of_rates(model, t, q, fastest));
    if (!std::isfinite(after.ratio) || (i > 0 && !(after.ratio < rest.ratio))) break;
    v = next;
    rates = std::move(next_rates);
    rest = after;
  }
  return rest;
}

}  // namespace mbs
