// What the long-double reference says of a scene: computed once, compared with every
// implementation.
#pragma once

#include <vector>

#include "mbs/simulation.hpp"
#include "reference/reference_simulation.hpp"
#include "run/stretch.hpp"
#include "scene/scene.hpp"

namespace mbs {

/// One step of the reference from a state that double precision holds exactly.
struct Probe {
  double t = 0.0;  ///< s, before the step
  State before, after;
  StepOutcome outcome;
  double condition = 0.0;      ///< of the tangent, 2-norm
  double jacobian_norm = 0.0;  ///< of Phi_q before the step, largest absolute row sum, m
};

struct ReferenceRun {
  Stretch stretch;
  std::vector<std::vector<double>> positions;    ///< q after each step of the stretch
  std::vector<std::vector<double>> multipliers;  ///< lambda after each step of the stretch
  std::vector<StepOutcome> outcomes;             ///< of each step
  std::vector<Probe> probes;                     ///< spread over the stretch, its ends included
};

/// Does the step of `probe.before` by `reference`, a simulation of `model`.
void take_probe(ReferenceSimulation& reference, const Model& model, Probe& probe);

/// Runs the reference over the stretch of `scene`: `most` steps (16 or more), fewer from 500
/// variables up so that its cost stays bounded, never fewer than 16. Throws UsageError if nothing
/// can be checked with these settings: the reference itself fails, or rounding may move q too far.
ReferenceRun run_reference(const Scene& scene, const StepSettings& settings, int most = 800);

}  // namespace mbs
