// Prefix by kind, letter by axis.
#include "scene/output_columns.hpp"

namespace mbs {

const char* vector_prefix(const Output& output) {
  switch (output.kind) {
    case Output::Kind::position:
      return ".";
    case Output::Kind::velocity:
      return ".v";
    case Output::Kind::acceleration:
      return ".a";
    case Output::Kind::constraint_force:
      return output.force == Output::Force::vector ? "." : nullptr;
    case Output::Kind::angle:
    case Output::Kind::distance:
    case Output::Kind::kinetic_energy:
    case Output::Kind::potential_energy:
    case Output::Kind::total_energy:
      break;
  }
  return nullptr;
}

std::vector<std::string> columns_of(const Output& output, int dimension) {
  const char* prefix = vector_prefix(output);
  if (prefix == nullptr) return {output.name};
  std::vector<std::string> columns;
  for (int axis = 0; axis < dimension; ++axis) {
    columns.push_back(output.name + prefix + "xyz"[axis]);
  }
  return columns;
}

}  // namespace mbs
