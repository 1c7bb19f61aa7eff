// What springs and dampers are to each coordinate, at the start.
#pragma once

#include <vector>

#include "mbs/model.hpp"

namespace mbs {

/// Diagonals (n) of K and C of Eqs. (11) and (18) at the start, N/m and N s/m. Laws count as
/// springs: as stiff as they become, as damped as they are at rest.
struct SpringDiagonal {
  std::vector<double> stiffness, damping;
};
SpringDiagonal spring_diagonal(const Model& model);

}  // namespace mbs
