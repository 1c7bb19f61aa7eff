// The tables of kinds. A new constraint is a file beside this and its row in the second table.
#include "scene_file/kinds/kinds.hpp"

namespace mbs {

using ReadItem = void(SceneReader&, const JsonNode&);
using LowerAll = void(Lowering&);

ReadItem read_point, read_vector, read_rod, read_mass, read_mass_matrix, read_body, read_constraint,
    read_spring, read_torsion_spring, read_force_law, read_torque_law, read_force, read_torque,
    read_output;
LowerAll lower_rods, lower_masses, lower_mass_matrices, lower_bodies, lower_constraints,
    lower_springs, lower_torsion_springs, lower_force_laws, lower_torque_laws, lower_forces,
    lower_torques, lower_outputs;

std::span<const ListKind> list_kinds() {
  static constexpr ListKind kKinds[] = {
      {"points", "point", true, read_point},  // Lowering::run() numbers points and vectors first
      {"vectors", "unit_vector", true, read_vector},
      {"rods", "rod", false, read_rod, lower_rods},
      {"masses", "mass", false, read_mass, lower_masses},
      {"mass_matrices", "mass_matrix", false, read_mass_matrix, lower_mass_matrices},
      {"bodies", "body", true, read_body, lower_bodies},
      {"constraints", "constraint", false, read_constraint, lower_constraints},
      {"springs", "spring", false, read_spring, lower_springs},
      {"torsion_springs", "torsion_spring", false, read_torsion_spring, lower_torsion_springs},
      {"force_laws", "force_law", false, read_force_law, lower_force_laws},
      {"torque_laws", "torque_law", false, read_torque_law, lower_torque_laws},
      {"forces", "force", false, read_force, lower_forces},
      {"torques", "torque", false, read_torque, lower_torques},
      {"outputs", "output", false, read_output, lower_outputs},
  };
  return kKinds;
}

using ReadConstraint = void(SceneReader&, const JsonNode&, DraftConstraint&);
using LowerConstraint = Lowering::Force(Lowering&, const DraftConstraint&);

/// Declares the functions read_TYPE and lower_TYPE of a type, and is its row.
#define MBS_CONSTRAINT(type)                                 \
  [] {                                                       \
    ReadConstraint read_##type;                              \
    LowerConstraint lower_##type;                            \
    return ConstraintKind{#type, read_##type, lower_##type}; \
  }()

std::span<const ConstraintKind> constraint_kinds() {
  static constexpr ConstraintKind kKinds[] = {
      MBS_CONSTRAINT(distance),      MBS_CONSTRAINT(angle),     MBS_CONSTRAINT(coincident),
      MBS_CONSTRAINT(perpendicular), MBS_CONSTRAINT(on_line),   MBS_CONSTRAINT(dot),
      MBS_CONSTRAINT(linear),        MBS_CONSTRAINT(prismatic), MBS_CONSTRAINT(cylindrical),
      MBS_CONSTRAINT(universal),
  };
  return kKinds;
}

}  // namespace mbs
