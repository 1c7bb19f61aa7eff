// Written for reading: one function an equation, no precomputed schedules.
#include "reference/reference_simulation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace mbs {

ReferenceSimulation::ReferenceSimulation(const Model& model, const StepSettings& settings)
    : Simulation(model.variables(), model.constraints()),
      model_(model),
      settings_(settings),
      n_(model.variables()),
      m_(model.constraints()),
      tangent_(envelope()) {}

ReferenceSimulation::Real ReferenceSimulation::coordinate(const Vector& x, int point,
                                                          int axis) const {
  const Point& p = model_.points()[point];
  return p.is_fixed() ? Real{p.position[axis]} : x[p.offset + axis];
}

ReferenceSimulation::Real ReferenceSimulation::velocity(const Vector& x, int point,
                                                        int axis) const {
  const Point& p = model_.points()[point];
  return p.is_fixed() ? Real{0} : x[p.offset + axis];
}

ReferenceSimulation::Vector ReferenceSimulation::constraints() const {
  Vector phi;
  for (const DotConstraint& c : model_.dot_constraints()) {  // Eq. (7)
    Real product = 0;
    for (int axis = 0; axis < model_.dimension(); ++axis) {
      product += (coordinate(q_, c.a, axis) - coordinate(q_, c.b, axis)) *
                 (coordinate(q_, c.c, axis) - coordinate(q_, c.d, axis));
    }
    phi.push_back(product - c.value);
  }
  for (const LinearConstraint& c : model_.linear_constraints()) {  // Eq. (8)
    Real sum = 0;
    for (const auto& term : c.terms) sum += term.coefficient * q_[term.coordinate];
    phi.push_back(sum - c.value);
  }
  return phi;
}

std::vector<ReferenceSimulation::Row> ReferenceSimulation::jacobian() const {
  std::vector<Row> rows;
  const auto points = model_.points();
  for (const DotConstraint& c : model_.dot_constraints()) {  // Eq. (7)
    Row row;
    for (int axis = 0; axis < model_.dimension(); ++axis) {
      const Real ab = coordinate(q_, c.a, axis) - coordinate(q_, c.b, axis);
      const Real cd = coordinate(q_, c.c, axis) - coordinate(q_, c.d, axis);
      const auto add = [&](int point, Real value) {
        if (!points[point].is_fixed()) row.push_back({points[point].offset + axis, value});
      };
      add(c.a, cd);
      add(c.b, -cd);
      add(c.c, ab);
      add(c.d, -ab);
    }
    rows.push_back(row);
  }
  for (const LinearConstraint& c : model_.linear_constraints()) {  // Eq. (8)
    Row row;
    for (const auto& term : c.terms) row.push_back({term.coordinate, term.coefficient});
    rows.push_back(row);
  }
  return rows;
}

ReferenceSimulation::Vector ReferenceSimulation::curvature() const {
  Vector result;
  for (const DotConstraint& c : model_.dot_constraints()) {  // Eq. (7)
    Real product = 0;
    for (int axis = 0; axis < model_.dimension(); ++axis) {
      product += (velocity(v_, c.a, axis) - velocity(v_, c.b, axis)) *
                 (velocity(v_, c.c, axis) - velocity(v_, c.d, axis));
    }
    result.push_back(2 * product);
  }
  result.resize(m_, Real{0});  // Eq. (8)
  return result;
}

ReferenceSimulation::Vector ReferenceSimulation::mass_times(const Vector& x) const {
  Vector y(n_, Real{0});
  for (const MassEntry& entry : model_.mass()) {
    y[entry.row] += entry.value * x[entry.col];
    if (entry.row != entry.col) y[entry.col] += entry.value * x[entry.row];
  }
  return y;
}

ReferenceSimulation::Vector ReferenceSimulation::transpose_times(const std::vector<Row>& rows,
                                                                 const Vector& x) const {
  Vector y(n_, Real{0});
  for (int k = 0; k < m_; ++k) {
    for (const Entry& entry : rows[k]) y[entry.coordinate] += entry.value * x[k];
  }
  return y;
}

std::vector<int> ReferenceSimulation::envelope() const {
  std::vector<int> first(n_);
  std::iota(first.begin(), first.end(), 0);
  for (const MassEntry& entry : model_.mass()) {
    if (entry.value != 0.0) first[entry.row] = std::min(first[entry.row], entry.col);
  }
  const auto couple = [&first](const std::vector<int>& coordinates) {
    if (coordinates.empty()) return;
    const int lowest = *std::min_element(coordinates.begin(), coordinates.end());
    for (const int i : coordinates) first[i] = std::min(first[i], lowest);
  };
  for (const DotConstraint& c : model_.dot_constraints()) {
    std::vector<int> coordinates;
    for (const int index : {c.a, c.b, c.c, c.d}) {
      const Point& point = model_.points()[index];
      for (int axis = 0; !point.is_fixed() && axis < model_.dimension(); ++axis) {
        coordinates.push_back(point.offset + axis);
      }
    }
    couple(coordinates);
  }
  for (const LinearConstraint& c : model_.linear_constraints()) {
    std::vector<int> coordinates;
    for (const auto& term : c.terms) coordinates.push_back(term.coordinate);
    couple(coordinates);
  }
  return first;
}

void ReferenceSimulation::assemble_tangent(const std::vector<Row>& rows) {
  const Real scale = Real{settings_.step} * settings_.step / 4 * settings_.penalty;
  tangent_.set_zero();
  for (const MassEntry& entry : model_.mass()) {
    if (entry.value != 0.0) tangent_.at(entry.row, entry.col) += entry.value;
  }
  for (const Row& row : rows) {  // Eq. (5)
    for (const Entry& x : row) {
      for (const Entry& y : row) {
        if (x.coordinate >= y.coordinate) {
          tangent_.at(x.coordinate, y.coordinate) += scale * x.value * y.value;
        }
      }
    }
  }
}

void ReferenceSimulation::do_set_state(const State& state) {
  q_.assign(state.q.begin(), state.q.end());
  v_.assign(state.v.begin(), state.v.end());
  a_.assign(state.a.begin(), state.a.end());
  lambda_.assign(state.lambda.begin(), state.lambda.end());
}

void ReferenceSimulation::do_get_state(State& state) const {
  const auto round = [](Real x) { return static_cast<double>(x); };
  std::transform(q_.begin(), q_.end(), state.q.begin(), round);
  std::transform(v_.begin(), v_.end(), state.v.begin(), round);
  std::transform(a_.begin(), a_.end(), state.a.begin(), round);
  std::transform(lambda_.begin(), lambda_.end(), state.lambda.begin(), round);
}

StepOutcome ReferenceSimulation::do_step() {
  const Real h = settings_.step;
  const Real alpha = settings_.penalty;
  for (int i = 0; i < n_; ++i) {  // predictor, and Eq. (2) on the difference
    const Real difference = h * v_[i] + h * h / 2 * a_[i];
    const Real v = v_[i];
    q_[i] += difference;
    v_[i] = 2 / h * difference - v;
    a_[i] = 4 / (h * h) * difference - 4 / h * v - a_[i];
  }
  for (int pass = 1; pass <= settings_.max_passes; ++pass) {
    const Vector phi = constraints();
    const std::vector<Row> rows = jacobian();
    Vector force = lambda_;
    for (int k = 0; k < m_; ++k) force[k] += alpha * phi[k];
    const Vector inertia = mass_times(a_);
    Vector delta = transpose_times(rows, force);
    for (int i = 0; i < n_; ++i) {  // minus f of Eq. (3)
      delta[i] = -h * h / 4 * (inertia[i] + delta[i] - model_.force()[i]);
    }
    assemble_tangent(rows);
    if (!tangent_.factorize()) return {StepStatus::factorization_failed, pass};
    tangent_.solve(delta);  // Eq. (4)

    bool converged = true;
    for (int i = 0; i < n_; ++i) {
      q_[i] += delta[i];
      v_[i] += 2 / h * delta[i];        // Eq. (2)
      a_[i] += 4 / (h * h) * delta[i];  // Eq. (2)
      if (!(std::abs(delta[i]) <= settings_.tolerance)) converged = false;
    }
    const Vector phi_after = constraints();
    for (int k = 0; k < m_; ++k) lambda_[k] += alpha * phi_after[k];  // Eq. (1)

    if (converged || pass == settings_.max_passes) {
      project();
      return {converged ? StepStatus::converged : StepStatus::pass_limit, pass};
    }
  }
  return {StepStatus::pass_limit, 0};  // max_passes < 1: nothing was done
}

void ReferenceSimulation::project() {
  const Real h = settings_.step;
  v_ = mass_times(v_);  // Eq. (6)
  tangent_.solve(v_);
  const Vector bending = transpose_times(jacobian(), curvature());
  a_ = mass_times(a_);  // Eq. (6)
  for (int i = 0; i < n_; ++i) a_[i] -= h * h / 4 * settings_.penalty * bending[i];
  tangent_.solve(a_);
}

double ReferenceSimulation::tangent_condition() {
  assemble_tangent(jacobian());
  EnvelopeCholesky factor = tangent_;
  if (!factor.factorize()) return std::numeric_limits<double>::infinity();
  const std::vector<Row> rows = jacobian();
  const Real scale = Real{settings_.step} * settings_.step / 4 * settings_.penalty;
  const auto multiply = [&](const Vector& x) {  // T x, Eq. (5), without the factor
    Vector projected(m_, Real{0});
    for (int k = 0; k < m_; ++k) {
      for (const Entry& entry : rows[k]) projected[k] += scale * entry.value * x[entry.coordinate];
    }
    Vector y = transpose_times(rows, projected);
    const Vector inertia = mass_times(x);
    for (int i = 0; i < n_; ++i) y[i] += inertia[i];
    return y;
  };
  const auto iterate = [this](auto&& apply) {  // power iteration: largest eigenvalue of `apply`
    Vector x(n_);
    for (int i = 0; i < n_; ++i) x[i] = 1 + std::sin(Real(i + 1)) / 2;
    Real norm = 0;
    for (int round = 0; round < 30; ++round) {
      norm = std::sqrt(std::inner_product(x.begin(), x.end(), x.begin(), Real{0}));
      for (Real& value : x) value /= norm;
      x = apply(x);
    }
    return std::sqrt(std::inner_product(x.begin(), x.end(), x.begin(), Real{0}));
  };
  const Real largest = iterate(multiply);
  const Real inverse_smallest = iterate([&](Vector x) {
    factor.solve(x);
    return x;
  });
  return static_cast<double>(largest * inverse_smallest);
}

}  // namespace mbs
