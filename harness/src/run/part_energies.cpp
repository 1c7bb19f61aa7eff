// Union of what elements join; a model of each part that no driver touches and that conserves.
#include "run/part_energies.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "model_math/connected_parts.hpp"
#include "model_math/kinematics.hpp"
#include "model_math/largest.hpp"

namespace mbs {
namespace {

/// Of `members` alone, which no element joins to others.
Model model_of(const Model& whole, const std::vector<int>& members, std::vector<int>& cols) {
  ModelData data = whole.data();
  std::vector<int> place(static_cast<std::size_t>(whole.variables()), -1);
  for (Point& point : data.points) point.offset = -1;
  cols.clear();
  for (const int member : members) {
    const auto m = static_cast<std::size_t>(member);
    data.points[m].offset = static_cast<int>(cols.size());
    for (int axis = 0; axis < whole.dimension(); ++axis) {
      const int col = whole.points()[m].offset + axis;
      place[static_cast<std::size_t>(col)] = static_cast<int>(cols.size());
      cols.push_back(col);
    }
  }
  const auto is_other = [&](int point) {
    return point < 0 || data.points[static_cast<std::size_t>(point)].is_fixed();
  };
  const auto on_line = [&](const auto& one) { return is_other(one.a) && is_other(one.b); };
  const auto about_axis = [&](const auto& one) {
    return on_line(one) && is_other(one.c) && is_other(one.d) && is_other(one.axis);
  };
  std::erase_if(data.springs, on_line);
  std::erase_if(data.force_laws, on_line);
  std::erase_if(data.torsion_springs, about_axis);
  std::erase_if(data.torque_laws, about_axis);
  std::erase_if(data.couples, [&](const Couple& c) { return on_line(c) && is_other(c.axis); });
  data.dot_constraints.clear();
  data.bilinear_constraints.clear();
  data.linear_constraints.clear();
  data.driven_points.clear();
  data.driven_values.clear();
  data.driven_mass.clear();
  data.mass.clear();
  for (MassEntry entry : whole.mass()) {
    entry.row = place[static_cast<std::size_t>(entry.row)];
    entry.col = place[static_cast<std::size_t>(entry.col)];
    if (entry.row < 0) continue;
    if (entry.row < entry.col) std::swap(entry.row, entry.col);
    data.mass.push_back(entry);
  }
  data.force.clear();
  data.initial_velocity.clear();
  for (const int col : cols) {
    data.force.push_back(whole.force()[static_cast<std::size_t>(col)]);
    data.initial_velocity.push_back(whole.initial_velocity()[static_cast<std::size_t>(col)]);
  }
  return Model(std::move(data));
}

/// Whether what depends on the rate is always against it, the straight ends included.
bool is_against_rate(const Law& law) {
  if (!law.factor.is_constant()) return false;
  const Curve& curve = law.by_rate;
  const double largest = largest_of(curve.breaks);
  const double factor = law.factor.at(0.0).value, far = 1e6 * largest;
  const auto force = [&](double rate) { return factor * curve.at(rate).value; };
  const double rounding = 1e-9 * (std::abs(force(largest)) + std::abs(force(-largest)));
  const auto is_against = [&](double rate) { return force(rate) * rate >= 0.0; };
  return std::abs(force(0.0)) <= rounding && std::ranges::all_of(curve.breaks, is_against) &&
         is_against(far) && is_against(-far);
}

/// Whether nothing but dampers changes the energy, which never grows then.
bool never_gains(const Model& model) {
  const auto is_damper = [](const auto& spring) { return spring.damping >= 0.0; };
  const auto is_brake = [](const auto& law) { return is_against_rate(law.law); };
  return std::ranges::all_of(model.springs(), is_damper) &&
         std::ranges::all_of(model.torsion_springs(), is_damper) &&
         std::ranges::all_of(model.force_laws(), is_brake) &&
         std::ranges::all_of(model.torque_laws(), is_brake) && model.couples().empty();
}

}  // namespace

double least_energy_scale(const Model& model, const std::vector<double>& q, double potential,
                          double size) {
  double force = 0.0, in_springs = potential;
  for (std::size_t i = 0; i < q.size(); ++i) {
    force += std::abs(model.force()[i]);
    in_springs += model.force()[i] * q[i];
  }
  double rest = 0.0;  // J, of a speed that is none; at rest without forces all else is rounding
  for (const double mass : mass_diagonal(model)) rest += mass * std::pow(1e-6 * size, 2) / 2;
  return std::max(1e-3 * (force * size + std::max(in_springs, 0.0)), rest);
}

void EnergyFigures::judge(double kinetic_now, double potential_now, bool loses) {
  kinetic = kinetic_now;
  scale = std::max(scale, kinetic);
  double off = kinetic + potential_now - reference;
  if (!loses) {
    excess = off;
  } else if (off < 0.0) {
    reference += off;
    off = 0.0;
  }
  // Not std::max, which would drop a NaN.
  if (!(std::abs(off) <= farthest)) farthest = std::isnan(off) ? HUGE_VAL : std::abs(off);
}

void EnergyFigures::add(double time) {
  if (!(kinetic > 0.0)) return;
  ahead += time * speed * (std::sqrt(std::max(1 + excess / kinetic, 0.0)) - 1);
  farthest_ahead = std::max(farthest_ahead, std::abs(ahead));
}

PartEnergies::PartEnergies(const Model& model, const State& initial, double start, double size) {
  for (const std::vector<int>& members : ConnectedParts(model).undriven()) {
    std::vector<int> cols;
    Model own = model_of(model, members, cols);
    if (!never_gains(own)) continue;
    const bool loses = !is_conservative(own);
    const std::string& name = model.points()[static_cast<std::size_t>(members.front())].name;
    Part part{std::move(own), name, std::move(cols), loses, {}, {}};
    take(initial, part);
    const double potential = potential_energy(part.model, start, part.q);
    start_.push_back({.reference = kinetic_energy(part.model, part.v) + potential,
                      .scale = least_energy_scale(part.model, part.q, potential, size)});
    parts_.push_back(std::move(part));
  }
}

void PartEnergies::take(const State& state, Part& part) {
  part.q.clear();
  part.v.clear();
  for (const int col : part.cols) {
    part.q.push_back(state.q[static_cast<std::size_t>(col)]);
    part.v.push_back(state.v[static_cast<std::size_t>(col)]);
  }
}

void PartEnergies::judge(double t, const State& state, std::vector<EnergyFigures>& figures) {
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    Part& part = parts_[i];
    take(state, part);
    figures[i].judge(kinetic_energy(part.model, part.v), potential_energy(part.model, t, part.q),
                     part.loses);
    const auto dimension = static_cast<std::size_t>(part.model.dimension());
    double fastest = 0.0;  // squared
    for (std::size_t k = 0; k < part.v.size(); k += dimension) {
      double squared = 0.0;
      for (std::size_t axis = 0; axis < dimension; ++axis)
        squared += part.v[k + axis] * part.v[k + axis];
      fastest = std::max(fastest, squared);
    }
    figures[i].speed = std::sqrt(fastest);
  }
}

}  // namespace mbs
