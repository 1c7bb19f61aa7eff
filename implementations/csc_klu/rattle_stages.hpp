// The stages that make one step of RATTLE, by its order.
#pragma once

#include <cmath>
#include <vector>

#include "mbs/simulation.hpp"

namespace mbs::csc_klu {

/// Lengths of the stages of a step of length h, s; they add up to h. multistep6 starts by rattle6.
inline std::vector<double> stage_lengths(Scheme scheme, double h) {
  if (scheme == Scheme::rattle4) {
    const double gamma = h / (4.0 - std::cbrt(4.0));
    return {gamma, gamma, h - 4.0 * gamma, gamma, gamma};
  }
  if (scheme == Scheme::rattle6 || scheme == Scheme::multistep6) {
    const double w1 = h * -1.17767998417887100694641568096431573;
    const double w2 = h * 0.235573213359358133684793182978534602;
    const double w3 = h * 0.784513610477557263819497633866349876;
    return {w3, w2, w1, h - 2.0 * (w1 + w2 + w3), w1, w2, w3};
  }
  return {h};
}

}  // namespace mbs::csc_klu
