// The stages that a step of RATTLE consists of.
#pragma once

#include <cmath>
#include <vector>

#include "mbs/simulation.hpp"

namespace mbs::eigen_dense {

/// The lengths of the stages, as shares of the step.
inline std::vector<double> stage_shares(Scheme scheme) {
  if (scheme == Scheme::rattle4) {
    const double gamma = 1.0 / (4.0 - std::cbrt(4.0));
    return {gamma, gamma, 1.0 - 4.0 * gamma, gamma, gamma};
  }
  if (scheme == Scheme::rattle6 || scheme == Scheme::multistep6) {
    constexpr double w1 = -1.17767998417887100694641568096431573;
    constexpr double w2 = 0.235573213359358133684793182978534602;
    constexpr double w3 = 0.784513610477557263819497633866349876;
    constexpr double w0 = 1.0 - 2.0 * (w1 + w2 + w3);
    return {w3, w2, w1, w0, w1, w2, w3};
  }
  return {1.0};
}

/// The same in s; the multistep method starts with those of rattle6.
template <typename Scalar>
std::vector<Scalar> stage_lengths(const StepSettings& settings) {
  std::vector<Scalar> lengths;
  for (const double share : stage_shares(settings.scheme)) {
    lengths.push_back(Scalar(share * settings.step));
  }
  return lengths;
}

}  // namespace mbs::eigen_dense
