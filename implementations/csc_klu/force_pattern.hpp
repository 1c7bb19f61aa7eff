// Where springs, laws and couples act, found once from the model.
#pragma once

#include <vector>

#include "extended_points.hpp"
#include "mbs/model.hpp"

namespace mbs::csc_klu {

/// Everything that gives Q at q', v': each an element with a gradient g, which has a block of `dim`
/// values for every free point of it. Order: springs and laws along lines, the same about axes,
/// couples; these alone have no share of C and K. Example, planar, a spring from A (fixed) to B:
/// one end, at B's first coordinate, with first = -1.
struct ForcePattern {
  struct Spring {
    int a, b;  ///< offsets into the extended vector
    double stiffness, damping, length;
    int ends_end;  ///< its ends end here and begin where those before end
  };
  struct LineLaw {
    int a, b;
    const Law* law;  ///< of the model
    int ends_end;
  };
  struct Torsion {
    int a, b, c, d, axis;  ///< offsets into the extended vector; planar: no axis
    double stiffness, damping, angle;
    int ends_end;
  };
  struct AxisLaw {
    int a, b, c, d, axis;
    const Law* law;
    int ends_end;
  };
  struct Couple {
    int a, b, axis;
    double torque;
    int ends_end;
  };

  /// `model` outlives this.
  explicit ForcePattern(const Model& model);
  /// Elements along lines, which come first.
  [[nodiscard]] int lines() const { return static_cast<int>(springs.size() + line_laws.size()); }
  /// Those with a share of C and K.
  [[nodiscard]] int stiff_elements() const {
    return lines() + static_cast<int>(torsions.size() + axis_laws.size());
  }
  /// Where the ends of these end.
  [[nodiscard]] std::vector<int> stiff_ends() const;

  std::vector<Spring> springs;
  std::vector<LineLaw> line_laws;
  std::vector<Torsion> torsions;
  std::vector<AxisLaw> axis_laws;
  std::vector<Couple> couples;
  std::vector<MovedPoint> ends;  ///< the free points of all elements, one after the other
};

}  // namespace mbs::csc_klu
