// Set-up: lowers springs, torsion springs and couples.
#include "force_layout.hpp"

#include <array>

namespace mbs::csc_umfpack {

ForceLayout::ForceLayout(const Model& model, const PointLayout& points) {
  const auto at = [&](int point) { return points.offsets[point]; };
  const auto axis = [&](int point) { return point < 0 ? 0 : points.offsets[point]; };
  const auto add_ends = [&](auto& element, std::span<const int> of) {
    const auto free = points.signs(of);
    element.first = static_cast<int>(ends.size());
    ends.insert(ends.end(), free.begin(), free.end());
    element.last = static_cast<int>(ends.size());
  };
  for (const auto& spring : model.springs()) {
    springs.push_back(
        {at(spring.a), at(spring.b), spring.stiffness, spring.damping, spring.length});
    add_ends(springs.back(), std::array{spring.a, spring.b});
  }
  for (const auto& spring : model.torsion_springs()) {
    torsion_springs.push_back({at(spring.a), at(spring.b), at(spring.c), at(spring.d),
                               axis(spring.axis), spring.stiffness, spring.damping, spring.angle});
    add_ends(torsion_springs.back(), std::array{spring.a, spring.b, spring.c, spring.d});
  }
  for (const auto& couple : model.couples()) {
    couples.push_back({at(couple.a), at(couple.b), axis(couple.axis), couple.torque});
    add_ends(couples.back(), std::array{couple.a, couple.b});
  }
}

}  // namespace mbs::csc_umfpack
