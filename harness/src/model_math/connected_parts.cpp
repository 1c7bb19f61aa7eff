// Union of what elements join.
#include "model_math/connected_parts.hpp"

#include <algorithm>
#include <numeric>

namespace mbs {

ConnectedParts::ConnectedParts(const Model& model, bool by_forces)
    : model_(model), leader_(model.points().size() + 1) {
  std::iota(leader_.begin(), leader_.end(), 0);
  is_driven_.resize(model.points().size(), false);
  for (const DrivenPoint& driven : model.driven_points()) is_driven_[at(driven.point)] = true;
  point_at_.resize(at(model.variables()) / dimension());
  for (std::size_t p = 0; p < model.points().size(); ++p) {
    const int offset = model.points()[p].offset;
    if (offset >= 0) point_at_[at(offset) / dimension()] = static_cast<int>(p);
  }
  std::vector<bool> is_driven_row(at(model.constraints()), false);
  for (const DrivenValue& value : model.driven_values()) is_driven_row[at(value.constraint)] = true;
  std::size_t row = 0;
  const auto quadratic = [&](const auto& c) {
    join({c.a, c.b, c.c, c.d});
    if (is_driven_row[row++]) drive({c.a, c.b, c.c, c.d});
  };
  for (const auto& c : model.dot_constraints()) quadratic(c);
  for (const auto& c : model.bilinear_constraints()) quadratic(c);
  for (const LinearConstraint& c : model.linear_constraints()) {
    for (const auto& term : c.terms) {
      join({owner(c.terms.front().coordinate), owner(term.coordinate)});
      if (is_driven_row[row]) drive({owner(term.coordinate)});
    }
    ++row;
  }
  for (const MassEntry& entry : model.mass()) join({owner(entry.row), owner(entry.col)});
  for (const DrivenMass& mass : model.driven_mass()) drive({owner(mass.coordinate)});
  if (!by_forces) return;
  const auto on_line = [&](const auto& one) { join({one.a, one.b}); };
  const auto about_axis = [&](const auto& one) { join({one.a, one.b, one.c, one.d, one.axis}); };
  std::ranges::for_each(model.springs(), on_line);
  std::ranges::for_each(model.force_laws(), on_line);
  std::ranges::for_each(model.torsion_springs(), about_axis);
  std::ranges::for_each(model.torque_laws(), about_axis);
  for (const Couple& couple : model.couples()) join({couple.a, couple.b, couple.axis});
}

std::vector<std::vector<int>> ConnectedParts::undriven() {
  std::vector<std::vector<int>> members(leader_.size());
  for (const int point : point_at_) members[at(find(point))].push_back(point);
  members[at(find(driver()))].clear();
  std::erase_if(members, [](const auto& one) { return one.empty(); });
  return members;
}

int ConnectedParts::find(int point) {
  while (leader_[at(point)] != point) point = leader_[at(point)] = leader_[at(leader_[at(point)])];
  return point;
}

void ConnectedParts::drive(std::initializer_list<int> points) {
  for (const int point : points) {
    if (!model_.points()[at(point)].is_fixed()) leader_[at(find(point))] = find(driver());
  }
}

void ConnectedParts::join(std::initializer_list<int> points) {
  int first = -1;
  for (const int point : points) {
    if (point < 0 || (model_.points()[at(point)].is_fixed() && !is_driven_[at(point)])) continue;
    const int leader = find(is_driven_[at(point)] ? driver() : point);
    if (first < 0) first = leader;
    leader_[at(leader)] = find(first);
  }
}

}  // namespace mbs
