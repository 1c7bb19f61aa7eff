// Where springs, laws and couples act, found once from the model.
#include "force_pattern.hpp"

namespace mbs::csc_klu {

ForcePattern::ForcePattern(const Model& model) {
  const std::vector<int> offset = extended_offsets(model);
  const auto axis_offset = [&](int axis) { return axis < 0 ? 0 : offset[axis]; };
  const auto append_ends = [&](std::initializer_list<int> abcd) {
    append_moved_points(model, abcd, ends);
    return static_cast<int>(ends.size());
  };
  for (const mbs::Spring& spring : model.springs()) {
    springs.push_back({offset[spring.a], offset[spring.b], spring.stiffness, spring.damping,
                       spring.length, append_ends({spring.a, spring.b})});
  }
  for (const ForceLaw& law : model.force_laws()) {
    line_laws.push_back({offset[law.a], offset[law.b], &law.law, append_ends({law.a, law.b})});
  }
  for (const TorsionSpring& spring : model.torsion_springs()) {
    torsions.push_back({offset[spring.a], offset[spring.b], offset[spring.c], offset[spring.d],
                        axis_offset(spring.axis), spring.stiffness, spring.damping, spring.angle,
                        append_ends({spring.a, spring.b, spring.c, spring.d})});
  }
  for (const TorqueLaw& law : model.torque_laws()) {
    axis_laws.push_back({offset[law.a], offset[law.b], offset[law.c], offset[law.d],
                         axis_offset(law.axis), &law.law,
                         append_ends({law.a, law.b, law.c, law.d})});
  }
  for (const mbs::Couple& couple : model.couples()) {
    couples.push_back({offset[couple.a], offset[couple.b], axis_offset(couple.axis), couple.torque,
                       append_ends({couple.a, couple.b})});
  }
}

std::vector<int> ForcePattern::stiff_ends() const {
  std::vector<int> stiff;
  const auto append = [&stiff](const auto& elements) {
    for (const auto& element : elements) stiff.push_back(element.ends_end);
  };
  append(springs);
  append(line_laws);
  append(torsions);
  append(axis_laws);
  return stiff;
}

}  // namespace mbs::csc_klu
