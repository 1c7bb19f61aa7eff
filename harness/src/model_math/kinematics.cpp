// Direct transcription of Eqs. (7) and (8) of paper/README.md, and of the energy.
#include "model_math/kinematics.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>

namespace mbs {
namespace {

using Vector = std::array<double, 3>;

void require_size(std::size_t found, int needed, const char* name) {
  if (found != static_cast<std::size_t>(needed)) {
    throw std::invalid_argument(std::string(name) + " has " + std::to_string(found) +
                                " entries, the model needs " + std::to_string(needed));
  }
}

/// What `q` holds for a point; `constant` supplies the value of a fixed one.
Vector of_point(const Model& model, const Point& point, std::span<const double> q,
                const Vector& constant) {
  Vector result{};
  for (int axis = 0; axis < model.dimension(); ++axis) {
    const auto i = static_cast<std::size_t>(axis);
    result[i] = point.is_fixed() ? constant[i] : q[static_cast<std::size_t>(point.offset) + i];
  }
  return result;
}

Vector minus(const Vector& x, const Vector& y) { return {x[0] - y[0], x[1] - y[1], x[2] - y[2]}; }
double dot(const Vector& x, const Vector& y) { return x[0] * y[0] + x[1] * y[1] + x[2] * y[2]; }

/// r_from - r_to.
Vector position_difference(const Model& model, int from, int to, std::span<const double> q) {
  const Point& x = model.points()[static_cast<std::size_t>(from)];
  const Point& y = model.points()[static_cast<std::size_t>(to)];
  return minus(of_point(model, x, q, x.position), of_point(model, y, q, y.position));
}
Vector velocity_difference(const Model& model, int from, int to, std::span<const double> v) {
  const Point& x = model.points()[static_cast<std::size_t>(from)];
  const Point& y = model.points()[static_cast<std::size_t>(to)];
  return minus(of_point(model, x, v, {}), of_point(model, y, v, {}));
}

double sum_of_terms(const LinearConstraint& constraint, std::span<const double> x) {
  double sum = 0.0;
  for (const auto& term : constraint.terms) {
    sum += term.coefficient * x[static_cast<std::size_t>(term.coordinate)];
  }
  return sum;
}

/// Appends the row of a dot constraint; the coefficients of coinciding points add up.
void append_row(const Model& model, const DotConstraint& constraint, std::span<const double> q,
                int row, std::vector<JacobianEntry>& entries) {
  const Vector first = position_difference(model, constraint.a, constraint.b, q);
  const Vector second = position_difference(model, constraint.c, constraint.d, q);
  const auto begin = static_cast<std::ptrdiff_t>(entries.size());
  const auto add = [&](int index, const Vector& value, double sign) {
    const Point& point = model.points()[static_cast<std::size_t>(index)];
    if (point.is_fixed()) return;
    for (int axis = 0; axis < model.dimension(); ++axis) {
      const int col = point.offset + axis;
      const auto found = std::find_if(entries.begin() + begin, entries.end(),
                                      [&](const JacobianEntry& entry) { return entry.col == col; });
      const double term = sign * value[static_cast<std::size_t>(axis)];
      if (found == entries.end()) {
        entries.push_back({row, col, term});
      } else {
        found->value += term;
      }
    }
  };
  add(constraint.a, second, 1.0);
  add(constraint.b, second, -1.0);
  add(constraint.c, first, 1.0);
  add(constraint.d, first, -1.0);
}

}  // namespace

void evaluate_constraints(const Model& model, std::span<const double> q, std::span<double> phi) {
  require_size(q.size(), model.variables(), "q");
  require_size(phi.size(), model.constraints(), "phi");
  std::size_t row = 0;
  for (const DotConstraint& constraint : model.dot_constraints()) {  // Eq. (7)
    phi[row++] = dot(position_difference(model, constraint.a, constraint.b, q),
                     position_difference(model, constraint.c, constraint.d, q)) -
                 constraint.value;
  }
  for (const LinearConstraint& constraint : model.linear_constraints()) {  // Eq. (8)
    phi[row++] = sum_of_terms(constraint, q) - constraint.value;
  }
}

void constraint_rate(const Model& model, std::span<const double> q, std::span<const double> v,
                     std::span<double> rate) {
  require_size(q.size(), model.variables(), "q");
  require_size(v.size(), model.variables(), "v");
  require_size(rate.size(), model.constraints(), "rate");
  std::size_t row = 0;
  for (const DotConstraint& constraint : model.dot_constraints()) {
    rate[row++] = dot(velocity_difference(model, constraint.a, constraint.b, v),
                      position_difference(model, constraint.c, constraint.d, q)) +
                  dot(position_difference(model, constraint.a, constraint.b, q),
                      velocity_difference(model, constraint.c, constraint.d, v));
  }
  for (const LinearConstraint& constraint : model.linear_constraints()) {
    rate[row++] = sum_of_terms(constraint, v);
  }
}

void constraint_curvature(const Model& model, std::span<const double> v,
                          std::span<double> curvature) {
  require_size(v.size(), model.variables(), "v");
  require_size(curvature.size(), model.constraints(), "curvature");
  std::ranges::fill(curvature, 0.0);  // Eq. (8)
  std::size_t row = 0;
  for (const DotConstraint& constraint : model.dot_constraints()) {  // Eq. (7)
    curvature[row++] = 2 * dot(velocity_difference(model, constraint.a, constraint.b, v),
                               velocity_difference(model, constraint.c, constraint.d, v));
  }
}

std::vector<JacobianEntry> jacobian(const Model& model, std::span<const double> q) {
  require_size(q.size(), model.variables(), "q");
  std::vector<JacobianEntry> entries;
  int row = 0;
  for (const DotConstraint& constraint : model.dot_constraints()) {
    append_row(model, constraint, q, row++, entries);
  }
  for (const LinearConstraint& constraint : model.linear_constraints()) {
    for (const auto& term : constraint.terms) {
      entries.push_back({row, term.coordinate, term.coefficient});
    }
    ++row;
  }
  std::sort(entries.begin(), entries.end(), [](const JacobianEntry& x, const JacobianEntry& y) {
    return x.row != y.row ? x.row < y.row : x.col < y.col;
  });
  return entries;
}

void mass_times(const Model& model, std::span<const double> x, std::span<double> y) {
  require_size(x.size(), model.variables(), "x");
  require_size(y.size(), model.variables(), "y");
  std::fill(y.begin(), y.end(), 0.0);
  for (const MassEntry& entry : model.mass()) {
    const auto row = static_cast<std::size_t>(entry.row);
    const auto col = static_cast<std::size_t>(entry.col);
    y[row] += entry.value * x[col];
    if (row != col) y[col] += entry.value * x[row];
  }
}

double kinetic_energy(const Model& model, std::span<const double> v) {
  std::vector<double> momentum(v.size());
  mass_times(model, v, momentum);
  double doubled = 0.0;
  for (std::size_t i = 0; i < v.size(); ++i) doubled += v[i] * momentum[i];
  return doubled / 2;
}

double energy(const Model& model, std::span<const double> q, std::span<const double> v) {
  require_size(q.size(), model.variables(), "q");
  double work = 0.0;
  for (std::size_t i = 0; i < q.size(); ++i) work += model.force()[i] * q[i];
  return kinetic_energy(model, v) - work;
}

}  // namespace mbs
