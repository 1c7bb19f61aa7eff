// The settings of a run that nobody chose by hand.
#pragma once

#include "run/run.hpp"
#include "run/settings.hpp"
#include "scene/scene.hpp"

namespace mbs::test {

/// Of `duration` (s), with automatic penalty factor and tolerance.
inline RunSettings automatic_settings(const Scene& scene, double duration) {
  RunSettings settings;
  settings.step = chosen(scene.model);
  settings.duration = duration;
  return settings;
}

/// The same with half the step beside.
inline RunSettings with_half_step(const Scene& scene, RunSettings settings) {
  settings.half_step = settings.step;
  settings.half_step->step /= 2;
  settings.half_step->penalty = automatic_penalty(scene.model, *settings.half_step);
  return settings;
}

}  // namespace mbs::test
