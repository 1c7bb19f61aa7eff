// The state of a simulation, and what every scheme evaluates of the model at it.
#pragma once

#include <algorithm>
#include <vector>

#include "drivers.hpp"
#include "forces.hpp"
#include "jacobian.hpp"
#include "mbs/simulation.hpp"
#include "storage.hpp"

namespace mbs::csc_klu {

/// The equations of a model at a state; starts at the model's initial position and velocity.
/// Forces come times dt^2/4, as Eq. (3) needs them.
template <int dim>
struct Equations {
  /// `step` is dt, s; `model` outlives this.
  Equations(const Model& model, double step);
  Equations(const Equations&) = delete;  // members refer to one another
  Equations& operator=(const Equations&) = delete;

  void set_state(const State& state);
  void get_state(State& state) const;

  /// Phi and Phi_q at q.
  void evaluate_constraints() {
    jacobian.evaluate(q.data(), phi.data());
    if (has_drivers) drivers.subtract_values(phi.data());
  }
  /// Phi alone.
  void evaluate_phi() {
    jacobian.evaluate_phi(q.data(), phi.data());
    if (has_drivers) drivers.subtract_values(phi.data());
  }
  /// The right-hand side -f of Eq. (4); without a penalty -f0 of Eq. (12). `right` has n numbers.
  void evaluate_residual(double penalty, double* right);
  /// After a pass of the penalty form.
  void update_multipliers(double penalty) {
    const double* __restrict const phi_i = phi.data();
    double* __restrict const lambda_i = lambda.data();
    for (int i = 0; i < m; ++i) lambda_i[i] += penalty * phi_i[i];  // Eq. (1)
  }

  const double weight;  ///< dt^2/4, s^2
  const int n, m;
  const MassMatrix mass;
  const JacobianPattern<dim> jacobian_pattern;
  Jacobian<dim> jacobian;
  const ForcePattern force_pattern;
  Forces<dim> forces;
  const bool has_forces;
  const DriverPattern<dim> driver_pattern;
  Drivers<dim> drivers;
  const bool has_drivers;

  std::vector<double> weighted_force;  ///< dt^2/4 times the constant part of Q (n)
  std::vector<double> q, v, a;         ///< extended by fixed points, their velocity, acceleration
  std::vector<double> lambda, phi;     ///< m, in the order of JacobianPattern
  std::vector<double> reaction;        ///< m; what Phi_q^T multiplies
};

template <int dim>
Equations<dim>::Equations(const Model& model, double step)
    : weight(step * step / 4.0),
      n(model.variables()),
      m(model.constraints()),
      mass(model),
      jacobian_pattern(model),
      jacobian(jacobian_pattern),
      force_pattern(model),
      forces(force_pattern, step),
      has_forces(forces.any()),
      driver_pattern(model, jacobian_pattern),
      drivers(driver_pattern),
      has_drivers(drivers.any()),
      weighted_force(model.force().begin(), model.force().end()),
      q(model.initial_position().begin(), model.initial_position().end()),
      v(model.initial_velocity().begin(), model.initial_velocity().end()),
      lambda(m, 0.0),
      phi(m, 0.0),
      reaction(m, 0.0) {
  for (double& force : weighted_force) force *= weight;
  const std::vector<double> fixed = fixed_coordinates(model);
  q.insert(q.end(), fixed.begin(), fixed.end());
  v.resize(q.size(), 0.0);
  a.resize(q.size(), 0.0);
  if (has_drivers) drivers.sample(0.0, q.data(), v.data(), a.data());
  evaluate_constraints();
  std::vector<double> unused(n);
  if (has_forces) forces.evaluate(q.data(), v.data(), unused.data());
}

template <int dim>
void Equations<dim>::set_state(const State& state) {
  std::ranges::copy(state.q, q.begin());
  std::ranges::copy(state.v, v.begin());
  std::ranges::copy(state.a, a.begin());
  for (int i = 0; i < m; ++i) lambda[i] = state.lambda[jacobian_pattern.model_row[i]];
}

template <int dim>
void Equations<dim>::get_state(State& state) const {
  std::copy_n(q.begin(), n, state.q.begin());
  std::copy_n(v.begin(), n, state.v.begin());
  std::copy_n(a.begin(), n, state.a.begin());
  for (int i = 0; i < m; ++i) state.lambda[jacobian_pattern.model_row[i]] = lambda[i];
}

template <int dim>
inline void Equations<dim>::evaluate_residual(double penalty, double* __restrict right) {
  const double* __restrict const phi_i = phi.data();
  const double* __restrict const lambda_i = lambda.data();
  double* __restrict const reaction_i = reaction.data();
  for (int i = 0; i < m; ++i) {
    reaction_i[i] = lambda_i[i] + penalty * phi_i[i];  // Eq. (3)
  }
  mass.multiply(a.data(), right);
  const double* __restrict const force = weighted_force.data();
  for (int i = 0; i < n; ++i) right[i] = force[i] - weight * right[i];  // Eq. (3)
  jacobian.subtract_transposed_product(reaction_i, weight, right);      // Eq. (3)
  if (has_forces) forces.evaluate(q.data(), v.data(), right);
  if (has_drivers) drivers.subtract_inertia(weight, a.data(), right);
}

}  // namespace mbs::csc_klu
