// The sequences of matrices that the strategies are compared on, each on one pattern.
#pragma once

#include <string>
#include <vector>

#include "csc_klu/lu_factors.hpp"
#include "csc_klu/storage.hpp"

namespace mbs::stale_pivots {

using namespace csc_klu;  // whose storage and solvers are measured

struct Sequence {
  Sequence(const char* its_name, const char* its_form) : name(its_name), form(its_form) {}

  std::string name;
  std::string form;  ///< "penalty": T of Eq. (5), or "saddle-point": Eq. (12)
  Structure::Kind kind = Structure::Kind::definite;
  Pattern pattern;
  std::vector<int> order;                     ///< of elimination; empty: AMD's
  std::vector<std::vector<double>> matrices;  ///< values on the pattern
};

/// All of them, four motions in several ways:
///   upright           the mechanism comes ever closer to the upright position
///   masses swap       neighbouring rods of 1e-6 and 1e6 kg change places at every matrix
///   contacts          springs 1e10 times stiffer, at other places in every matrix
///   multipliers swap  geometric stiffness that grows and changes signs at every matrix
/// Multipliers are ordered and scaled as in a simulation, by the first matrix, unless a name says
/// something else.
[[nodiscard]] std::vector<Sequence> all_sequences();

}  // namespace mbs::stale_pivots
