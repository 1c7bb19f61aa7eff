// Only rows that a driver touches are visited.
#include "drivers.hpp"

#include <cstddef>

namespace mbs::csc_cholmod {
namespace {

constexpr Matrix kIdentity{{{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}};

}  // namespace

Drivers::Drivers(const Model& model, const StepSettings& settings, const Coordinates& coordinates,
                 const LoweredConstraints& lowered, const std::vector<double>& force)
    : coordinates_(coordinates),
      half_(settings.step / 2.0),
      quarter_(half_ * half_),
      points_(model.driven_points()) {
  if (points_.empty() && model.driven_values().empty()) return;
  rates_.resize(coordinates.all() - coordinates.unknowns());
  accelerations_.resize(rates_.size());
  add_rows(model, lowered);
  add_mass(model, force);
}

void Drivers::add_rows(const Model& model, const LoweredConstraints& lowered) {
  std::vector<char> is_driven(model.points().size());
  for (const DrivenPoint& p : points_) is_driven[p.point] = 1;
  std::vector<const TimeFunction*> function(model.constraints());
  for (const DrivenValue& v : model.driven_values()) function[v.constraint] = &v.value;

  int constraint = 0;
  const auto add = [&](bool moves, const std::array<int, 4>& point, const Matrix* B) {
    const int k = constraint++;
    if (!moves && function[k] == nullptr) return;
    if (function[k] != nullptr) values_.push_back({static_cast<int>(rows_.size()), function[k]});
    rows_.push_back({lowered.row(k), moves, point, B});
  };
  const auto add_pair = [&](const auto& c, const Matrix* B) {
    add(is_driven[c.a] || is_driven[c.b] || is_driven[c.c] || is_driven[c.d], {c.a, c.b, c.c, c.d},
        B);
  };
  for (const DotConstraint& c : model.dot_constraints()) add_pair(c, &kIdentity);
  for (const BilinearConstraint& c : model.bilinear_constraints()) add_pair(c, &c.B);
  while (constraint < model.constraints()) add(false, {}, nullptr);
}

void Drivers::add_mass(const Model& model, const std::vector<double>& force) {
  for (const DrivenMass& m : model.driven_mass()) {
    const int place = coordinates_.number()[m.coordinate];
    const int source = coordinates_.place(m.point, m.axis) - coordinates_.unknowns();
    mass_.push_back({place, source, m.value, force[place]});
  }
}

void Drivers::drive(double t, double* q, double* u, double* target, double* force) {
  const int unknowns = coordinates_.unknowns();
  for (const DrivenPoint& p : points_) {
    for (int axis = 0; axis < coordinates_.dimension(); ++axis) {
      const TimeFunction::Sample sample = p.position[axis].at(t);
      const int place = coordinates_.place(p.point, axis);
      q[place] = sample.value;
      u[place] = rates_[place - unknowns] = half_ * sample.rate;
      accelerations_[place - unknowns] = quarter_ * sample.acceleration;
    }
  }
  for (const Value& v : values_) {
    const TimeFunction::Sample sample = v.function->at(t);
    DrivenRow& row = rows_[v.driven_row];
    target[row.row] = sample.value;
    row.rate = half_ * sample.rate;
    row.acceleration = quarter_ * sample.acceleration;
  }
  for (const Mass& m : mass_) force[m.place] = m.force;
  for (const Mass& m : mass_) force[m.place] -= m.value * accelerations_[m.source];
}

double Drivers::terms(const DrivenRow& row, const double* q,
                      const std::vector<double>& motion) const {
  if (!row.moves) return 0.0;
  const int unknowns = coordinates_.unknowns();
  const auto place = [&](int k, int axis) { return coordinates_.place(row.point[k], axis); };
  const auto moved = [&](int p) { return p < unknowns ? 0.0 : motion[p - unknowns]; };
  double sum = 0.0;
  for (int i = 0; i < coordinates_.dimension(); ++i) {
    const int a = place(0, i);
    const int b = place(1, i);
    for (int j = 0; j < coordinates_.dimension(); ++j) {
      const int c = place(2, j);
      const int d = place(3, j);
      const double term = (moved(a) - moved(b)) * (q[c] - q[d]) +  // Eq. (7)
                          (q[a] - q[b]) * (moved(c) - moved(d));
      sum += (*row.B)[i][j] * term;
    }
  }
  return sum;
}

}  // namespace mbs::csc_cholmod
