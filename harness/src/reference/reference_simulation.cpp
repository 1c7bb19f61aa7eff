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
      known_(model, 0.0) {
  set_up_matrix();
}

namespace {

using Real = ReferenceSimulation::Real;
using Triple = ReferenceSimulation::Triple;

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

std::vector<ReferenceSimulation::MatrixEntry> ReferenceSimulation::geometric_stiffness() const {
  std::vector<MatrixEntry> result;
  if (!settings_.geometric_stiffness) return result;
  const Real h = settings_.step;
  const Vector phi = constraints();
  int row = 0;
  for_quadratic(model_, [&](const auto& c) {  // Eq. (16)
    const Real g = lambda_[row] + (is_saddle() ? 0 : settings_.penalty * phi[row]);
    ++row;
    for (const auto& [x, x_sign] : {std::pair{c.a, 1}, std::pair{c.b, -1}}) {
      for (const auto& [y, y_sign] : {std::pair{c.c, 1}, std::pair{c.d, -1}}) {
        if (offset(x) < 0 || offset(y) < 0) continue;
        for (int l = 0; l < model_.dimension(); ++l) {
          Triple unit{};
          unit[l] = h * h / 4 * g * x_sign * y_sign;
          const Triple column = right(c, unit);
          for (int k = 0; k < model_.dimension(); ++k) {
            if (column[k] == 0) continue;
            result.push_back({offset(x) + k, offset(y) + l, column[k]});
            result.push_back({offset(y) + l, offset(x) + k, column[k]});
          }
        }
      }
    }
  });
  return result;
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

ReferenceSimulation::Vector ReferenceSimulation::times(const std::vector<Row>& rows,
                                                       const Vector& x) const {
  Vector y(m_, Real{0});
  for (int k = 0; k < m_; ++k) {
    for (const Entry& entry : rows[k]) y[k] += entry.value * x[entry.coordinate];
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

void ReferenceSimulation::assemble(const std::vector<Row>& rows) {
  const Real scale = Real{settings_.step} * settings_.step / 4 * settings_.penalty;  // 1 / eps
  const auto add = [this](int i, int k, Real value) {
    matrix_.at(std::max(place_[i], place_[k]), std::min(place_[i], place_[k])) += value;
  };
  matrix_.set_zero();
  for (const MassEntry& entry : model_.mass()) {
    if (entry.value != 0.0) add(entry.row, entry.col, entry.value);
  }
  for (int k = 0; k < m_; ++k) {
    if (is_saddle()) add(n_ + k, n_ + k, -1 / scale);  // Eqs. (12), (14)
    for (const Entry& x : rows[k]) {
      if (is_saddle()) add(n_ + k, x.coordinate, x.value);
      for (const Entry& y : rows[k]) {  // Eq. (5)
        if (!is_saddle() && x.coordinate >= y.coordinate) {
          add(x.coordinate, y.coordinate, scale * x.value * y.value);
        }
      }
    }
  }
  if (is_rattle()) return;
  last_elements_ = elements();
  for (const Element& element : last_elements_) add_element(element);
  last_geometric_ = geometric_stiffness();
  for (const MatrixEntry& entry : last_geometric_) {
    if (entry.row >= entry.col) add(entry.row, entry.col, entry.value);
  }
}

bool ReferenceSimulation::factorize(const std::vector<Row>& rows) {
  assemble(rows);
  if (settings_.geometric_stiffness) return matrix_.factorize({});
  return matrix_.factorize(is_saddle() ? m_ : 0);
}

ReferenceSimulation::Solution ReferenceSimulation::solve(const std::vector<Row>& rows,
                                                         const Vector& top,
                                                         const Vector& bottom) const {
  if (!is_saddle()) {
    const Real scale = Real{settings_.step} * settings_.step / 4 * settings_.penalty;
    const Vector term = transpose_times(rows, bottom);
    Vector x = top;
    for (int i = 0; i < n_; ++i) x[i] += scale * term[i];
    solve_matrix(x);
    return {x, {}};
  }
  Vector both = top;
  both.insert(both.end(), bottom.begin(), bottom.end());
  solve_matrix(both);
  return {{both.begin(), both.begin() + n_}, {both.begin() + n_, both.end()}};
}

void ReferenceSimulation::solve_matrix(Vector& x) const {
  Vector moved(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) moved[place_[i]] = x[i];
  matrix_.solve(moved);
  for (std::size_t i = 0; i < x.size(); ++i) x[i] = moved[place_[i]];
}

void ReferenceSimulation::do_set_state(const State& state) {
  q_.assign(state.q.begin(), state.q.end());
  v_.assign(state.v.begin(), state.v.end());
  a_.assign(state.a.begin(), state.a.end());
  lambda_.assign(state.lambda.begin(), state.lambda.end());
  known_.set_time(time());
  steps_ = 0;
  due_ = true;
  w_.clear();
  past_a_.clear();
  if (!is_rattle()) return;
  const std::vector<Row> rows = jacobian();
  if (factorize(rows)) rattle_acceleration(rows);
}

void ReferenceSimulation::do_get_state(State& state) const {
  const auto round = [](Real x) { return static_cast<double>(x); };
  std::transform(q_.begin(), q_.end(), state.q.begin(), round);
  std::transform(v_.begin(), v_.end(), state.v.begin(), round);
  std::transform(a_.begin(), a_.end(), state.a.begin(), round);
  std::transform(lambda_.begin(), lambda_.end(), state.lambda.begin(), round);
}

StepOutcome ReferenceSimulation::do_step() {
  ++steps_;
  known_.set_time(time());
  if (settings_.scheme == Scheme::multistep6) return multistep();
  return is_rattle() ? rattle_step(settings_.scheme) : trapezoidal_step();
}

namespace {

/// Power iteration: the largest eigenvalue of `apply`, to a few per cent.
template <class Apply>
Real largest_eigenvalue(int size, Apply&& apply) {
  ReferenceSimulation::Vector x(size);
  for (int i = 0; i < size; ++i) x[i] = 1 + std::sin(Real(i + 1)) / 2;
  const auto norm_of = [&x] {
    return std::sqrt(std::inner_product(x.begin(), x.end(), x.begin(), Real{0}));
  };
  for (int round = 0; round < 30; ++round) {
    const Real norm = norm_of();
    for (Real& value : x) value /= norm;
    x = apply(x);
  }
  return norm_of();
}

}  // namespace

double ReferenceSimulation::effective_penalty() const {
  if (!is_saddle() || m_ == 0) return settings_.penalty;
  const Real inverse = largest_eigenvalue(
      m_, [this](const Vector& y) { return solve({}, Vector(n_, Real{0}), y).y; });
  const Real h = settings_.step;
  return std::min(settings_.penalty, static_cast<double>(4 / (h * h) * inverse));
}

double ReferenceSimulation::tangent_condition() const {
  StepSettings settings = settings_;
  settings.scheme = Scheme::penalty;
  settings.penalty = effective_penalty();
  settings.geometric_stiffness = false;
  ReferenceSimulation penalty_form(model_, settings);
  penalty_form.q_ = q_;
  penalty_form.v_ = v_;
  penalty_form.known_.set_time(time());
  const std::vector<Row> rows = penalty_form.jacobian();
  if (!penalty_form.factorize(rows)) return std::numeric_limits<double>::infinity();
  const Real scale = Real{settings.step} * settings.step / 4 * settings.penalty;
  const Real largest = largest_eigenvalue(n_, [&](const Vector& x) {  // T x without the factor
    Vector y = transpose_times(rows, times(rows, x));
    const Vector inertia = penalty_form.weighted_mass_times(x);
    for (int i = 0; i < n_; ++i) y[i] = inertia[i] + scale * y[i];
    return y;
  });
  const Real inverse_smallest = largest_eigenvalue(n_, [&](Vector x) {
    penalty_form.solve_matrix(x);
    return x;
  });
  return static_cast<double>(largest * inverse_smallest);
}

}  // namespace mbs
