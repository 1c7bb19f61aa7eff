// Checks at the border of batches, and what makes models fit into one.
#include "mbs/batch.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "check_state.hpp"

namespace mbs {
namespace {

/// Whether each item of `a` is like the one of `b` at its place.
template <class Items, class Alike>
bool all_alike(const Items& a, const Items& b, Alike alike) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), alike);
}

template <class Item>
bool same_four(const Item& x, const Item& y) {
  return x.a == y.a && x.b == y.b && x.c == y.c && x.d == y.d;
}

bool same_zero(double x, double y) { return (x == 0.0) == (y == 0.0); }

bool same_matrix(const BilinearConstraint& x, const BilinearConstraint& y) {
  return all_alike(x.B, y.B,
                   [](const auto& r, const auto& s) { return all_alike(r, s, same_zero); });
}

bool same_points(const Model& a, const Model& b) {
  return a.dimension() == b.dimension() &&
         all_alike(a.points(), b.points(), [](const Point& x, const Point& y) {
           return x.offset == y.offset && x.is_vector == y.is_vector;
         });
}

bool same_constraints(const Model& a, const Model& b) {
  const auto same_terms = [](const LinearConstraint& x, const LinearConstraint& y) {
    return all_alike(x.terms, y.terms,
                     [](const auto& s, const auto& t) { return s.coordinate == t.coordinate; });
  };
  return all_alike(a.dot_constraints(), b.dot_constraints(), same_four<DotConstraint>) &&
         all_alike(
             a.bilinear_constraints(), b.bilinear_constraints(),
             [](const auto& x, const auto& y) { return same_four(x, y) && same_matrix(x, y); }) &&
         all_alike(a.linear_constraints(), b.linear_constraints(), same_terms);
}

bool same_laws(const Model& a, const Model& b) {
  const auto same_law = [](const Law& x, const Law& y) {
    return x.by_position.breaks.size() == y.by_position.breaks.size() &&
           x.by_rate.breaks.size() == y.by_rate.breaks.size() &&
           x.factor.is_constant() == y.factor.is_constant();
  };
  return all_alike(a.force_laws(), b.force_laws(),
                   [same_law](const ForceLaw& x, const ForceLaw& y) {
                     return x.a == y.a && x.b == y.b && same_law(x.law, y.law);
                   }) &&
         all_alike(a.torque_laws(), b.torque_laws(),
                   [same_law](const TorqueLaw& x, const TorqueLaw& y) {
                     return same_four(x, y) && x.axis == y.axis && same_law(x.law, y.law);
                   });
}

bool same_forces(const Model& a, const Model& b) {
  const auto same_values = [](const auto& x, const auto& y) {
    return same_zero(x.stiffness, y.stiffness) && same_zero(x.damping, y.damping);
  };
  const auto same_spring = [same_values](const Spring& x, const Spring& y) {
    return x.a == y.a && x.b == y.b && same_values(x, y);
  };
  const auto same_torsion = [same_values](const TorsionSpring& x, const TorsionSpring& y) {
    return same_four(x, y) && x.axis == y.axis && same_values(x, y);
  };
  return all_alike(a.springs(), b.springs(), same_spring) &&
         all_alike(a.torsion_springs(), b.torsion_springs(), same_torsion) &&
         all_alike(a.couples(), b.couples(), [](const Couple& x, const Couple& y) {
           return x.a == y.a && x.b == y.b && x.axis == y.axis;
         });
}

bool same_drivers(const Model& a, const Model& b) {
  return all_alike(a.driven_points(), b.driven_points(),
                   [](const auto& x, const auto& y) { return x.point == y.point; }) &&
         all_alike(a.driven_values(), b.driven_values(),
                   [](const auto& x, const auto& y) { return x.constraint == y.constraint; }) &&
         all_alike(a.driven_mass(), b.driven_mass(), [](const DrivenMass& x, const DrivenMass& y) {
           return x.coordinate == y.coordinate && x.point == y.point && x.axis == y.axis;
         });
}

}  // namespace

bool have_same_shape(const Model& a, const Model& b) {
  return same_points(a, b) && same_constraints(a, b) && same_forces(a, b) && same_laws(a, b) &&
         same_drivers(a, b) &&
         all_alike(a.mass(), b.mass(), [](const MassEntry& x, const MassEntry& y) {
           return x.row == y.row && x.col == y.col;
         });
}

bool have_same_method(const StepSettings& a, const StepSettings& b) {
  return a.step == b.step && a.max_passes == b.max_passes && a.projections == b.projections &&
         a.projections_every == b.projections_every && a.scheme == b.scheme &&
         a.multipliers == b.multipliers && a.tangent == b.tangent && a.precision == b.precision &&
         a.geometric_stiffness == b.geometric_stiffness;
}

BatchSimulation::BatchSimulation(std::span<const Model* const> models,
                                 std::span<const StepSettings> settings)
    : lanes_(models.size(), Lane::unset), starts_(models.size(), 0.0) {
  if (models.empty() || models.size() != settings.size()) {
    throw std::invalid_argument("a batch of " + std::to_string(models.size()) + " models and " +
                                std::to_string(settings.size()) + " settings");
  }
  for (std::size_t i = 1; i < models.size(); ++i) {
    if (have_same_shape(*models[0], *models[i]) && have_same_method(settings[0], settings[i])) {
      continue;
    }
    throw std::invalid_argument("lane " + std::to_string(i) + " is not of the batch's shape");
  }
  variables_ = models[0]->variables();
  constraints_ = models[0]->constraints();
  step_ = settings[0].step;
}

void BatchSimulation::set_state(int lane, const State& state) {
  const auto i = static_cast<std::size_t>(lane);
  Lane& status = lanes_.at(i);
  check_state(state, variables_, constraints_);
  if (steps_ > 0) std::ranges::fill(lanes_, Lane::unset);
  steps_ = 0;
  start_ = starts_[i] = state.t;
  status = Lane::running;
  do_set_state(lane, state);
}

void BatchSimulation::get_state(int lane, State& state) const {
  if (lanes_.at(static_cast<std::size_t>(lane)) != Lane::running) {
    throw std::logic_error("lane " + std::to_string(lane) + " has no state");
  }
  const auto n = static_cast<std::size_t>(variables_);
  state.q.resize(n);
  state.v.resize(n);
  state.a.resize(n);
  state.lambda.resize(static_cast<std::size_t>(constraints_));
  do_get_state(lane, state);
  state.t = time();
}

void BatchSimulation::step(std::span<StepOutcome> outcomes) {
  if (outcomes.size() != lanes_.size()) throw std::invalid_argument("one outcome a lane");
  if (steps_ == 0) require_ready();
  ++steps_;
  do_step(outcomes);
}

void BatchSimulation::require_ready() {
  for (std::size_t i = 0; i < lanes_.size(); ++i) {
    if (lanes_[i] == Lane::retired) continue;
    if (lanes_[i] == Lane::unset || starts_[i] != start_) {
      throw std::logic_error("lane " + std::to_string(i) + " is not set to the others' time");
    }
  }
}

void BatchSimulation::retire(int lane) {
  lanes_.at(static_cast<std::size_t>(lane)) = Lane::retired;
  do_retire(lane);
}

bool BatchSimulation::is_retired(int lane) const {
  return lanes_.at(static_cast<std::size_t>(lane)) == Lane::retired;
}

}  // namespace mbs
