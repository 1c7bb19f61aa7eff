// Where points are in the extended vector, and which free points a term of the equations moves.
#pragma once

#include <initializer_list>
#include <vector>

#include "mbs/model.hpp"

namespace mbs::csc_klu {

/// Offsets of all points in the extended vector: the n coordinates of q, followed by those of the
/// fixed points (driven ones included), so that no loop asks which are fixed.
[[nodiscard]] std::vector<int> extended_offsets(const Model& model);
/// Tail of the extended position vector, m.
[[nodiscard]] std::vector<double> fixed_coordinates(const Model& model);

/// A free point of a term that depends on u = r_a - r_b and w = r_c - r_d. A derivative by the
/// point is first times that by u plus second times that by w.
struct MovedPoint {
  int coordinate;        ///< its first in q
  double first, second;  ///< from -2 to 2: signs, added up where points coincide
};

/// Appends the free points among a, b and perhaps c, d (indices into Model::points()), each once.
void append_moved_points(const Model& model, std::initializer_list<int> abcd,
                         std::vector<MovedPoint>& points);

}  // namespace mbs::csc_klu
