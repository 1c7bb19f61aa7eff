// Set-up of the force elements and the positions of their share of T.
#include <algorithm>

#include "forces.hpp"

namespace mbs::starting_sparse {

Forces::Forces(const Model& model, std::span<const int> point_offset, double step)
    : variables_(model.variables()),
      dimension_(model.dimension()),
      half_step_(0.5 * step),
      weight_(0.25 * step * step) {
  for (const Spring& spring : model.springs()) {
    const int a = point_offset[spring.a], b = point_offset[spring.b];
    springs_.push_back(
        {a, b, free_ends(a, b), spring.stiffness, spring.damping, spring.length, {}, 0.0, 0.0});
  }
  for (const TorsionSpring& spring : model.torsion_springs()) append_torsion(spring, point_offset);
  for (const Couple& couple : model.couples()) {
    const int a = point_offset[couple.a], b = point_offset[couple.b];
    const int axis = couple.axis < 0 ? 0 : point_offset[couple.axis];
    couples_.push_back({a, b, axis, free_ends(a, b), couple.torque});
  }
}

Forces::Ends Forces::free_ends(int a, int b) const {
  Ends ends;
  const auto append = [&](int offset, double sign) {
    if (offset >= variables_) return;
    ends.column[ends.count] = offset;
    ends.sign[ends.count++] = sign;
  };
  append(std::min(a, b), a < b ? 1.0 : -1.0);
  append(std::max(a, b), a < b ? -1.0 : 1.0);
  return ends;
}

void Forces::append_torsion(const TorsionSpring& spring, std::span<const int> point_offset) {
  TorsionElement torsion{};
  torsion.point = {point_offset[spring.a], point_offset[spring.b], point_offset[spring.c],
                   point_offset[spring.d]};
  torsion.axis = spring.axis < 0 ? 0 : point_offset[spring.axis];
  torsion.stiffness = spring.stiffness;
  torsion.damping = spring.damping;
  torsion.angle = spring.angle;
  std::array<int, 4> sorted = torsion.point;
  std::sort(sorted.begin(), sorted.end());
  const auto distinct = std::unique(sorted.begin(), sorted.end());
  const auto free = std::lower_bound(sorted.begin(), distinct, variables_);
  torsion.count = static_cast<int>(free - sorted.begin());
  torsion.column = sorted;
  for (int k = 0; k < 4; ++k) {
    const auto found = std::find(sorted.begin(), free, torsion.point[k]);
    torsion.slot[k] = found == free ? 4 : static_cast<int>(found - sorted.begin());
  }
  torsions_.push_back(torsion);
}

void Forces::append_positions(std::vector<int>& rows, std::vector<int>& columns) const {
  const auto append_blocks = [&](int count, const auto& column) {
    for_each_entry(count, [&](int s, int i, int r, int j) {
      rows.push_back(column[s] + i + 1);
      columns.push_back(column[r] + j + 1);
    });
  };
  for (const SpringElement& spring : springs_) {
    append_blocks(spring.ends.count, spring.ends.column);
  }
  for (const TorsionElement& torsion : torsions_) append_blocks(torsion.count, torsion.column);
}

}  // namespace mbs::starting_sparse
