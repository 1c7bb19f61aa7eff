// The size of a scene, to which lengths and violations are compared.
#pragma once

#include <span>

#include "mbs/model.hpp"

namespace mbs {

/// Largest distance along one axis that the points (fixed ones too; not the unit vectors) span at
/// t = 0, m; 1 if they span none.
double extent(std::span<const Point> points);

}  // namespace mbs
