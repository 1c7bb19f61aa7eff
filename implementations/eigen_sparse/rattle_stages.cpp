// Stages of RATTLE and its compositions.
#include "rattle_stages.hpp"

#include <cmath>

namespace mbs::eigen_sparse {
namespace {

/// Lengths of the stages of a step, as shares of it.
std::vector<double> shares_of(Scheme scheme) {
  if (scheme == Scheme::rattle4) {
    const double gamma = 1.0 / (4.0 - std::cbrt(4.0));
    return {gamma, gamma, 1.0 - 4.0 * gamma, gamma, gamma};
  }
  if (scheme == Scheme::rattle6) {
    const double w1 = -1.17767998417887100694641568096431573;
    const double w2 = 0.235573213359358133684793182978534602;
    const double w3 = 0.784513610477557263819497633866349876;
    const double w0 = 1.0 - 2.0 * (w1 + w2 + w3);
    return {w3, w2, w1, w0, w1, w2, w3};
  }
  return {1.0};
}

}  // namespace

std::vector<double> rattle_stages(const StepSettings& settings) {
  std::vector<double> stages = shares_of(settings.scheme);
  for (double& stage : stages) stage *= settings.step;
  return stages;
}

}  // namespace mbs::eigen_sparse
