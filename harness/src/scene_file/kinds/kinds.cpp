// The table of kinds. A new one is a file beside this, its functions' names and its line here.
#include "scene_file/kinds/kinds.hpp"

namespace mbs {

using ReadItem = void(SceneReader&, const JsonNode&);
using LowerAll = void(Lowering&);
using ReadConstraint = void(SceneReader&, const JsonNode&, DraftConstraint&);
using LowerConstraint = Lowering::Force(Lowering&, const DraftConstraint&);

ReadItem read_point, read_vector, read_rod, read_mass, read_mass_matrix, read_body, read_constraint, read_spring,
    read_torsion_spring, read_force_law, read_torque_law, read_force, read_torque, read_output;
LowerAll lower_rods, lower_masses, lower_mass_matrices, lower_bodies, lower_constraints, lower_springs,
    lower_torsion_springs, lower_force_laws, lower_torque_laws, lower_torques, lower_outputs;
ReadConstraint read_distance, read_angle, read_coincident, read_perpendicular, read_on_line,
    read_dot, read_linear, read_prismatic, read_cylindrical, read_universal;
LowerConstraint lower_distance, lower_angle, lower_coincident, lower_perpendicular, lower_on_line,
    lower_dot, lower_linear, lower_prismatic, lower_cylindrical, lower_universal;

std::span<const ListKind> list_kinds() {
  static constexpr ListKind kKinds[] = {
      {"points", "point", true, read_point},  // Lowering::run() numbers points and vectors first
      {"vectors", "unit_vector", true, read_vector},
      {"rods", "rod", false, read_rod, lower_rods},
      {"masses", "mass", false, read_mass, lower_masses},
      {"mass_matrices", "mass_matrix", false, read_mass_matrix, lower_mass_matrices},
      {"bodies", "body", true, read_body, lower_bodies},  // and forces, which may be on bodies
      {"constraints", "constraint", false, read_constraint, lower_constraints},
      {"springs", "spring", false, read_spring, lower_springs},
      {"torsion_springs", "torsion_spring", false, read_torsion_spring, lower_torsion_springs},
      {"force_laws", "force_law", false, read_force_law, lower_force_laws},
      {"torque_laws", "torque_law", false, read_torque_law, lower_torque_laws},
      {"forces", "force", false, read_force},
      {"torques", "torque", false, read_torque, lower_torques},
      {"outputs", "output", false, read_output, lower_outputs},
  };
  return kKinds;
}

std::span<const ConstraintKind> constraint_kinds() {
  static constexpr ConstraintKind kKinds[] = {
      {"distance", read_distance, lower_distance},
      {"angle", read_angle, lower_angle},
      {"coincident", read_coincident, lower_coincident},
      {"perpendicular", read_perpendicular, lower_perpendicular},
      {"on_line", read_on_line, lower_on_line},
      {"dot", read_dot, lower_dot},
      {"linear", read_linear, lower_linear},
      {"prismatic", read_prismatic, lower_prismatic},
      {"cylindrical", read_cylindrical, lower_cylindrical},
      {"universal", read_universal, lower_universal},
  };
  return kKinds;
}

}  // namespace mbs
