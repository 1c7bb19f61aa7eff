// Stages of RATTLE and its compositions: paper/README.md, "RATTLE".
#pragma once

#include <cmath>
#include <span>

#include "mbs/simulation.hpp"

namespace mbs::compiled_ldl {

/// Lengths of a step's stages, in steps; of the first steps of the multistep method too.
inline std::span<const double> stage_lengths(Scheme scheme) {
  static constexpr double kOnce[] = {1.0};
  static const double g = 1.0 / (4.0 - std::cbrt(4.0));
  static const double kFourth[] = {g, g, 1.0 - 4.0 * g, g, g};
  static constexpr double w1 = -1.17767998417887100694641568096431573;
  static constexpr double w2 = 0.235573213359358133684793182978534602;
  static constexpr double w3 = 0.784513610477557263819497633866349876;
  static constexpr double w0 = 1.0 - 2.0 * (w1 + w2 + w3);
  static constexpr double kSixth[] = {w3, w2, w1, w0, w1, w2, w3};
  if (scheme == Scheme::rattle4) return kFourth;
  if (scheme == Scheme::rattle6 || scheme == Scheme::multistep6) return kSixth;
  return kOnce;
}

}  // namespace mbs::compiled_ldl
