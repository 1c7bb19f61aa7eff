// Written for reading: one function an equation, no precomputed schedules.
#include "reference/reference_simulation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace mbs {

ReferenceSimulation::ReferenceSimulation(const Model& model, const StepSettings& settings)
    : Simulation(model, settings),
      model_(model),
      settings_(settings),
      n_(model.variables()),
      m_(model.constraints()),
      known_(model, 0.0),
      tangent_(envelope()) {}

namespace {

using Real = ReferenceSimulation::Real;
using Triple = std::array<Real, 3>;

Real dot(const Triple& x, const Triple& y) { return x[0] * y[0] + x[1] * y[1] + x[2] * y[2]; }
Triple minus(const Triple& x, const Triple& y) { return {x[0] - y[0], x[1] - y[1], x[2] - y[2]}; }

/// B w and B^T u; for a dot constraint B is the identity.
Triple right(const DotConstraint&, const Triple& w) { return w; }
Triple left(const DotConstraint&, const Triple& u) { return u; }
Triple right(const BilinearConstraint& c, const Triple& w) {
  Triple result{};
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) result[i] += c.B[i][k] * w[k];
  }
  return result;
}
Triple left(const BilinearConstraint& c, const Triple& u) {
  Triple result{};
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) result[k] += c.B[i][k] * u[i];
  }
  return result;
}

template <class Function>
void for_quadratic(const Model& model, Function&& function) {
  for (const DotConstraint& c : model.dot_constraints()) function(c);
  for (const BilinearConstraint& c : model.bilinear_constraints()) function(c);
}

}  // namespace

Triple ReferenceSimulation::position(int point) const {
  if (offset(point) < 0) {
    const auto r = known_.position(point);
    return {r[0], r[1], model_.dimension() == 3 ? r[2] : 0.0};
  }
  Triple r{};
  for (int k = 0; k < model_.dimension(); ++k) r[k] = q_[offset(point) + k];
  return r;
}

Triple ReferenceSimulation::velocity(int point) const {
  Triple v{};
  if (offset(point) < 0) {
    const auto known = known_.velocity(point);
    std::copy(known.begin(), known.end(), v.begin());
    return v;
  }
  for (int k = 0; k < model_.dimension(); ++k) v[k] = v_[offset(point) + k];
  return v;
}

Triple ReferenceSimulation::difference(int a, int b) const {
  return minus(position(a), position(b));
}
Triple ReferenceSimulation::velocity_difference(int a, int b) const {
  return minus(velocity(a), velocity(b));
}

Triple ReferenceSimulation::known_velocity_difference(int a, int b) const {
  const auto of = [this](int point) { return offset(point) < 0 ? velocity(point) : Triple{}; };
  return minus(of(a), of(b));
}

Triple ReferenceSimulation::known_acceleration_difference(int a, int b) const {
  const auto of = [this](int point) {
    Triple result{};
    const auto known = known_.acceleration(point);
    if (offset(point) < 0) std::copy(known.begin(), known.end(), result.begin());
    return result;
  };
  return minus(of(a), of(b));
}

ReferenceSimulation::Vector ReferenceSimulation::constraints() const {
  Vector phi;
  for_quadratic(model_, [&](const auto& c) {  // Eq. (7)
    phi.push_back(dot(difference(c.a, c.b), right(c, difference(c.c, c.d))) -
                  known_.values()[phi.size()].value);
  });
  for (const LinearConstraint& c : model_.linear_constraints()) {  // Eq. (8)
    Real sum = 0;
    for (const auto& term : c.terms) sum += term.coefficient * q_[term.coordinate];
    phi.push_back(sum - known_.values()[phi.size()].value);
  }
  return phi;
}

std::vector<ReferenceSimulation::Row> ReferenceSimulation::jacobian() const {
  std::vector<Row> rows;
  for_quadratic(model_, [&](const auto& c) {  // Eq. (7)
    Row row;
    const auto add = [&](int point, Real sign, const Triple& value) {
      for (int k = 0; offset(point) >= 0 && k < model_.dimension(); ++k) {
        row.push_back({offset(point) + k, sign * value[k]});
      }
    };
    const Triple at_ab = right(c, difference(c.c, c.d));
    const Triple at_cd = left(c, difference(c.a, c.b));
    add(c.a, 1, at_ab);
    add(c.b, -1, at_ab);
    add(c.c, 1, at_cd);
    add(c.d, -1, at_cd);
    rows.push_back(row);
  });
  for (const LinearConstraint& c : model_.linear_constraints()) {  // Eq. (8)
    Row row;
    for (const auto& term : c.terms) row.push_back({term.coordinate, term.coefficient});
    rows.push_back(row);
  }
  return rows;
}

ReferenceSimulation::Vector ReferenceSimulation::partial_rate() const {
  Vector result;
  for_quadratic(model_, [&](const auto& c) {  // Eq. (7)
    result.push_back(dot(known_velocity_difference(c.a, c.b), right(c, difference(c.c, c.d))) +
                     dot(difference(c.a, c.b), right(c, known_velocity_difference(c.c, c.d))));
  });
  result.resize(m_, Real{0});  // Eq. (8)
  for (int k = 0; k < m_; ++k) result[k] -= known_.values()[k].rate;
  return result;
}

ReferenceSimulation::Vector ReferenceSimulation::curvature() const {
  Vector result;
  for_quadratic(model_, [&](const auto& c) {  // Eq. (7)
    result.push_back(
        2 * dot(velocity_difference(c.a, c.b), right(c, velocity_difference(c.c, c.d))) +
        dot(known_acceleration_difference(c.a, c.b), right(c, difference(c.c, c.d))) +
        dot(difference(c.a, c.b), right(c, known_acceleration_difference(c.c, c.d))));
  });
  result.resize(m_, Real{0});  // Eq. (8)
  for (int k = 0; k < m_; ++k) result[k] -= known_.values()[k].acceleration;
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
  const auto couple_points = [&](std::initializer_list<int> points) {
    std::vector<int> coordinates;
    for (const int point : points) {
      for (int k = 0; offset(point) >= 0 && k < model_.dimension(); ++k) {
        coordinates.push_back(offset(point) + k);
      }
    }
    couple(coordinates);
  };
  for_quadratic(model_, [&](const auto& c) { couple_points({c.a, c.b, c.c, c.d}); });
  for (const Spring& spring : model_.springs()) couple_points({spring.a, spring.b});
  for (const TorsionSpring& s : model_.torsion_springs()) couple_points({s.a, s.b, s.c, s.d});
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
  last_elements_ = elements();
  for (const Element& element : last_elements_) add_element(element);
}

void ReferenceSimulation::do_set_state(const State& state) {
  q_.assign(state.q.begin(), state.q.end());
  v_.assign(state.v.begin(), state.v.end());
  a_.assign(state.a.begin(), state.a.end());
  lambda_.assign(state.lambda.begin(), state.lambda.end());
  known_.set_time(time());
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
  known_.set_time(time());
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
    const Vector applied = applied_force();
    Vector delta = transpose_times(rows, force);
    for (int i = 0; i < n_; ++i) {  // minus f of Eq. (3)
      delta[i] = -h * h / 4 * (inertia[i] + delta[i] - applied[i]);
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
  if (settings_.projections == Projections::none) return;
  const Real factor = Real{settings_.step} * settings_.step / 4 * settings_.penalty;
  const std::vector<Row> rows = jacobian();
  const auto projected = [&](const Vector& x, const Vector& rate) {  // Eq. (6)
    Vector right = weighted_mass_times(x);
    const Vector term = transpose_times(rows, rate);
    for (int i = 0; i < n_; ++i) right[i] -= factor * term[i];
    tangent_.solve(right);
    return right;
  };
  v_ = projected(v_, partial_rate());
  if (settings_.projections == Projections::both) a_ = projected(a_, curvature());
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
    const Vector inertia = weighted_mass_times(x);
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
