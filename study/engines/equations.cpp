// Sums over the terms of a planar scene.
#include "equations.hpp"

#include <cmath>

#include "engine.hpp"

namespace engines {
namespace {

void refuse(bool there, const char* what) {
  if (there) throw UsageError(std::string("no scene ") + what + " is given to a solver");
}

}  // namespace

Equations::Equations(const mbs::Model& model)
    : n_(static_cast<std::size_t>(model.variables())),
      gravity_(model.force().begin(), model.force().end()) {
  refuse(model.dimension() != 2, "in three dimensions");
  refuse(!model.torsion_springs().empty(), "with torsion springs");
  refuse(!model.force_laws().empty() || !model.torque_laws().empty(), "with laws of force");
  refuse(!model.driven_points().empty() || !model.driven_values().empty(), "with drivers");
  start_.assign(model.initial_position().begin(), model.initial_position().end());
  std::vector<std::size_t> places;  // of each point's x in an extended vector
  for (const mbs::Point& point : model.points()) {
    places.push_back(point.is_fixed() ? start_.size() : static_cast<std::size_t>(point.offset));
    if (point.is_fixed()) start_.insert(start_.end(), {point.position[0], point.position[1]});
  }
  for (const mbs::MassEntry& entry : model.mass()) {
    const auto row = static_cast<std::size_t>(entry.row),
               column = static_cast<std::size_t>(entry.col);
    mass_.push_back({row, column, entry.value});
    if (row != column) mass_.push_back({column, row, entry.value});
  }
  take_constraints(model, places);
  take_forces(model, places);
}

void Equations::take_constraints(const mbs::Model& model, const std::vector<std::size_t>& places) {
  const auto add = [&](const auto& one, std::size_t left, std::size_t right, double coefficient) {
    const auto at = [&](int point, std::size_t axis) {
      return places[static_cast<std::size_t>(point)] + axis;
    };
    if (coefficient != 0.0)
      products_.push_back({values_.size(), coefficient, at(one.a, left), at(one.b, left),
                           at(one.c, right), at(one.d, right)});
  };
  for (const mbs::DotConstraint& one : model.dot_constraints()) {
    for (const std::size_t axis : {0, 1}) add(one, axis, axis, 1.0);
    values_.push_back(one.value);
  }
  for (const mbs::BilinearConstraint& one : model.bilinear_constraints()) {
    for (const std::size_t left : {0, 1}) {
      for (const std::size_t right : {0, 1}) add(one, left, right, one.B[left][right]);
    }
    values_.push_back(one.value);
  }
  for (const mbs::LinearConstraint& one : model.linear_constraints()) {
    for (const auto& term : one.terms)
      linear_.push_back(
          {values_.size(), static_cast<std::size_t>(term.coordinate), term.coefficient});
    values_.push_back(one.value);
  }
}

void Equations::take_forces(const mbs::Model& model, const std::vector<std::size_t>& places) {
  for (const mbs::Spring& one : model.springs()) {
    refuse(one.damping != 0.0, "with dampers");
    springs_.push_back({places[static_cast<std::size_t>(one.a)],
                        places[static_cast<std::size_t>(one.b)], one.stiffness, one.length});
  }
  for (const mbs::Couple& one : model.couples())
    couples_.push_back({places[static_cast<std::size_t>(one.a)],
                        places[static_cast<std::size_t>(one.b)], one.torque});
}

void Equations::constraints(const double* q, const double* v, const double* a, double* phi,
                            double* rate, double* acceleration) const {
  for (std::size_t k = 0; k < m(); ++k) {
    phi[k] = -values_[k];
    rate[k] = acceleration[k] = 0.0;
  }
  for (const Product& one : products_) {
    const double u = q[one.a] - q[one.b], w = q[one.c] - q[one.d];
    const double u_rate = v[one.a] - v[one.b], w_rate = v[one.c] - v[one.d];
    phi[one.row] += one.coefficient * u * w;
    rate[one.row] += one.coefficient * (u_rate * w + u * w_rate);
    acceleration[one.row] += one.coefficient * ((a[one.a] - a[one.b]) * w +
                                                u * (a[one.c] - a[one.d]) + 2 * u_rate * w_rate);
  }
  for (const Entry& one : linear_) {
    phi[one.row] += one.coefficient * q[one.column];
    rate[one.row] += one.coefficient * v[one.column];
    acceleration[one.row] += one.coefficient * a[one.column];
  }
}

void Equations::add_reaction(const double* q, const double* lambda, double* sum) const {
  for (const Product& one : products_) {
    const double factor = one.coefficient * lambda[one.row];
    const double u = factor * (q[one.a] - q[one.b]), w = factor * (q[one.c] - q[one.d]);
    sum[one.a] += w;
    sum[one.b] -= w;
    sum[one.c] += u;
    sum[one.d] -= u;
  }
  for (const Entry& one : linear_) sum[one.column] += one.coefficient * lambda[one.row];
}

void Equations::add_inertia_and_force(const double* q, const double* a, double* sum) const {
  for (const Entry& one : mass_) sum[one.row] += one.coefficient * a[one.column];
  for (std::size_t i = 0; i < n_; ++i) sum[i] -= gravity_[i];
  for (const Element& one : springs_) {
    const double x = q[one.a] - q[one.b], y = q[one.a + 1] - q[one.b + 1],
                 length = std::hypot(x, y);
    const double pull = one.strength * (length - one.length) / length;
    sum[one.a] += pull * x;
    sum[one.a + 1] += pull * y;
    sum[one.b] -= pull * x;
    sum[one.b + 1] -= pull * y;
  }
  for (const Element& one : couples_) {
    const double x = q[one.a] - q[one.b], y = q[one.a + 1] - q[one.b + 1];
    const double turn = one.strength / (x * x + y * y);
    sum[one.a] += turn * y;
    sum[one.a + 1] -= turn * x;
    sum[one.b] -= turn * y;
    sum[one.b + 1] += turn * x;
  }
}

void Equations::write_mass(double factor, Corner at, SparseWriter& to) const {
  for (const Entry& one : mass_) write(one.row, one.column, factor * one.coefficient, at, to);
}

void Equations::write_jacobian(const double* q, double factor, Corner at, SparseWriter& to,
                               bool transposed) const {
  const auto add = [&](std::size_t row, std::size_t column, double value) {
    if (column >= n_) return;
    transposed ? to.add(at.row + column, at.column + row, value)
               : to.add(at.row + row, at.column + column, value);
  };
  for (const Product& one : products_) {
    const double scale = factor * one.coefficient;
    const double u = scale * (q[one.a] - q[one.b]), w = scale * (q[one.c] - q[one.d]);
    add(one.row, one.a, w);
    add(one.row, one.b, -w);
    add(one.row, one.c, u);
    add(one.row, one.d, -u);
  }
  for (const Entry& one : linear_) add(one.row, one.column, factor * one.coefficient);
}

void Equations::write_jacobian_change(const double* x, double factor, Corner at,
                                      SparseWriter& to) const {
  for (const Product& one : products_) {
    const double scale = factor * one.coefficient;
    const double u = scale * (x[one.a] - x[one.b]), w = scale * (x[one.c] - x[one.d]);
    write(one.row, one.a, w, at, to);
    write(one.row, one.b, -w, at, to);
    write(one.row, one.c, u, at, to);
    write(one.row, one.d, -u, at, to);
  }
}

void Equations::write_reaction_change(const double* lambda, Corner at, SparseWriter& to) const {
  const auto both = [&](std::size_t i, std::size_t j, double value) {
    if (i >= n_ || j >= n_) return;
    write(i, j, value, at, to);
    write(j, i, value, at, to);
  };
  for (const Product& one : products_) {
    const double value = one.coefficient * lambda[one.row];
    both(one.a, one.c, value);
    both(one.a, one.d, -value);
    both(one.b, one.c, -value);
    both(one.b, one.d, value);
  }
}

void Equations::write_stiffness(const double* q, Corner at, SparseWriter& to) const {
  // A block acts on the difference of two points, and its opposite on the second.
  const auto blocks = [&](const Element& one, double xx, double xy, double yx, double yy) {
    const double block[2][2] = {{xx, xy}, {yx, yy}};
    for (const auto& [row, column, sign] :
         {std::tuple{one.a, one.a, 1.0}, std::tuple{one.a, one.b, -1.0},
          std::tuple{one.b, one.a, -1.0}, std::tuple{one.b, one.b, 1.0}}) {
      if (row >= n_) continue;
      for (const std::size_t i : {0, 1}) {
        for (const std::size_t j : {0, 1}) write(row + i, column + j, sign * block[i][j], at, to);
      }
    }
  };
  for (const Element& one : springs_) {
    const double x = q[one.a] - q[one.b], y = q[one.a + 1] - q[one.b + 1],
                 length = std::hypot(x, y);
    const double pull = one.strength * (1 - one.length / length);
    const double along = (one.strength - pull) / (length * length);
    blocks(one, pull + along * x * x, along * x * y, along * x * y, pull + along * y * y);
  }
  for (const Element& one : couples_) {
    const double x = q[one.a] - q[one.b], y = q[one.a + 1] - q[one.b + 1], square = x * x + y * y;
    const double turn = one.strength / square, change = 2 * turn / square;
    blocks(one, -change * x * y, turn - change * y * y, change * x * x - turn, change * x * y);
  }
}

}  // namespace engines
