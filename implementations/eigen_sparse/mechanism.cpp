// State of the model, prediction, residuals and right-hand sides.
#include "mechanism.hpp"

#include <algorithm>
#include <utility>

namespace mbs::eigen_sparse {

Mechanism::Mechanism(const Model& model, Coordinates numbering)
    : coordinates(std::move(numbering)),
      constraints(model, coordinates),
      mass(mass_matrix(model, coordinates)),
      force(model.variables()),
      q(Vector::Zero(coordinates.extended())),
      v(Vector::Zero(coordinates.extended())),
      a(Vector::Zero(model.variables())),
      lambda(Vector::Zero(model.constraints())) {
  coordinates.gather({model.force().begin(), model.force().end()}, force);
  const std::vector<double>& fixed = coordinates.fixed();
  std::copy(fixed.begin(), fixed.end(), q.data() + model.variables());
  if (!model.driven_points().empty() || !model.driven_values().empty()) {
    drivers.emplace(model, coordinates, constraints.order());
  }
}

void Mechanism::add_forces(const Model& model, const Layout& layout, double step) {
  const ForceSetup setup{model, coordinates, layout, step};
  append_springs(setup, forces);
  append_torsion_springs(setup, forces);
  append_couples(setup, forces);
}

void Mechanism::add_held(const Model& model, const Layout& layout, double step) {
  const ForceSetup setup{model, coordinates, layout, step};
  append_springs(setup, held);
  append_torsion_springs(setup, held);
}

void Mechanism::hold(Vector& scratch) {
  for (const auto& element : held) element->apply(q, v, scratch);
}

void Mechanism::set_state(const State& state) {
  coordinates.gather(state.q, q);
  coordinates.gather(state.v, v);
  coordinates.gather(state.a, a);
  const std::vector<int>& order = constraints.order();
  for (std::size_t row = 0; row < order.size(); ++row) lambda[row] = state.lambda[order[row]];
}

void Mechanism::get_state(State& state) const {
  coordinates.scatter(q, state.q);
  coordinates.scatter(v, state.v);
  coordinates.scatter(a, state.a);
  const std::vector<int>& order = constraints.order();
  for (std::size_t row = 0; row < order.size(); ++row) state.lambda[order[row]] = lambda[row];
}

void Mechanism::predict(double step, Vector& scratch) {
  auto position = q.head(a.size());
  auto velocity = v.head(a.size());
  scratch = position;
  position += step * velocity + (0.5 * step * step) * a;
  scratch = position - scratch;
  a = (4.0 / (step * step)) * scratch - (4.0 / step) * velocity - a;  // Eq. (2)
  velocity = (2.0 / step) * scratch - velocity;                       // Eq. (2)
}

double Mechanism::correct(double step, const Vector& delta) {
  q.head(a.size()) += delta;
  v.head(a.size()) += (2.0 / step) * delta;
  a += (4.0 / (step * step)) * delta;
  return largest_of(delta);
}

void Mechanism::applied_force(Vector& result) {
  result = force;
  for (const auto& element : forces) element->apply(q, v, result);
}

void Mechanism::unbalanced_force(const Vector& multiplier, Vector& result) {
  applied_force(result);
  result.noalias() -= mass * a;
  result.noalias() += constraints.jacobian().transpose() * multiplier;
}

void Mechanism::add_to_tangent(double* values) const {
  for (const auto& element : in_tangent()) element->add_to_tangent(values);
}

void Mechanism::multiply(const Vector& x, Vector& result) {
  result.noalias() = mass * x;
  for (const auto& element : in_tangent()) element->add_product(x, result);
}

void Mechanism::evaluate() {
  constraints.evaluate(q);
  if (drivers) drivers->evaluate(q);
}

void Mechanism::rates(Vector& result) const {
  result.setZero();
  if (drivers) drivers->add_rates(result);
}

void Mechanism::accelerations(Vector& result) const {
  constraints.velocity_terms(v, result);
  if (drivers) drivers->add_accelerations(result);
}

}  // namespace mbs::eigen_sparse
