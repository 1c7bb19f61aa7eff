// Which models are chains of points, and what each place of a chain has.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "mbs/model.hpp"

namespace mbs::compiled_chains {

/// At most so many distances to fixed points a free point.
inline constexpr int kMostRods = 2;

/// A distance: its row in Phi, or -1 if there is none. Phi = |offset + difference|^2 - value, with
/// the difference of the local coordinates that it relates.
struct Distance {
  int row = -1;
  std::array<double, 2> offset{};  // m
  double value = 0.0;              // m^2
};

/// A free point, with what couples it to the next one.
struct Place {
  int coordinate = -1;             // first of its two entries in q
  std::array<double, 2> origin{};  // of its local coordinates, m
  std::array<Distance, kMostRods> rods;
  Distance link;                     // from here to the next
  std::array<double, 3> mass{};      // xx, xy, yy, kg
  std::array<double, 4> coupling{};  // of M between here and the next, by rows, kg
  std::array<double, 2> force{};     // N
};

/// Two points of 1 kg hang from A = (5, 0), rods of 1 m, A - P and P - Q: the places are
///
///     coordinate  origin  rods               link               mass     force
///     0 (P)       (5, 0)  {row 0, value 1}   {row 1, value 1}   1, 0, 1  (0, −9.81)
///     2 (Q)       (5, 0)                                        1, 0, 1  (0, −9.81)
///
/// all offsets and couplings 0, since both points are relative to A; least_rods 0, most_rods 1.
struct Topology {
  std::vector<Place> places;  // in the order of the chain; several chains one after the other
  bool isotropic = true;      // all blocks of M are multiples of the identity
  double coupling = 0.0;      // of M between neighbours, kg, if all are the same multiple of it
  int least_rods = 0;         // of all points
  int most_rods = 0;
};

/// Nothing if `model` is not a chain.
std::optional<Topology> find_chain(const Model& model);

}  // namespace mbs::compiled_chains
