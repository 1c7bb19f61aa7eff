// Springs, torsion springs and couples lowered to flat arrays.
#pragma once

#include <vector>

#include "layout.hpp"
#include "mbs/model.hpp"

namespace mbs::csc_umfpack {

/// Every element names its points by offsets into x, which its scalar depends on, and has a range
/// of `ends`: the free ones among them, which it acts on.
struct ForceLayout {
  struct Spring {
    int a = 0, b = 0;
    double stiffness = 0.0, damping = 0.0, length = 0.0;
    int first = 0, last = 0;  ///< its ends
  };
  struct TorsionSpring {
    int a = 0, b = 0, c = 0, d = 0;
    int axis = 0;  ///< offset of z in x; planar: 0, not used
    double stiffness = 0.0, damping = 0.0, angle = 0.0;
    int first = 0, last = 0;
  };
  struct Couple {
    int a = 0, b = 0, axis = 0;
    double torque = 0.0;
    int first = 0, last = 0;
  };

  ForceLayout(const Model& model, const PointLayout& points);

  std::vector<Spring> springs;
  std::vector<TorsionSpring> torsion_springs;
  std::vector<Couple> couples;
  std::vector<PointLayout::Signs> ends;  ///< of springs, then torsion springs, then couples
};

}  // namespace mbs::csc_umfpack
