// Steps the reference through the stretch and takes the lock-step probes.
#include "check/reference_run.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "check/lock_step.hpp"
#include "describe/warnings.hpp"
#include "model_math/extent.hpp"
#include "model_math/kinematics.hpp"
#include "run/settings.hpp"
#include "usage_error.hpp"

namespace mbs {

namespace {

/// Largest absolute row sum of Phi_q.
double row_sum_norm(const Model& model, const State& state) {
  std::vector<double> sums(static_cast<std::size_t>(model.constraints()) + 1, 0.0);
  for (const JacobianEntry& entry : jacobian(model, state.t, state.q)) {
    sums[static_cast<std::size_t>(entry.row)] += std::abs(entry.value);
  }
  return *std::ranges::max_element(sums);
}

/// What `mbs describe` says against the settings that the reference fails with, or what often helps.
std::string what_helps(const Model& model, const StepSettings& settings) {
  const bool is_auto = settings.penalty == automatic_penalty(model, settings);
  const std::vector<std::string> known =
      setting_warnings(model, settings, is_auto ? PenaltyFrom::rule : PenaltyFrom::user);
  if (!known.empty()) return fmt::format("{}", fmt::join(known, "; "));
  return fmt::format("choose a shorter step{}", is_auto ? "" : ", or let --penalty be auto");
}

/// A bound that no difference exceeds says nothing.
void require_judgeable(const Scene& scene, const StepSettings& settings, const Probe& probe) {
  const double size = extent(scene.model.points()), most = most_allowed(settings);
  const double allowed = lock_step_tolerance(probe, settings).q;
  if (allowed <= most * size) return;
  throw UsageError(fmt::format(
      "scene '{}': nothing can be compared with step {:g} s and penalty {:.3g}: in the step from "
      "t = {:g} s rounding may move q by {:.1e} m, more than {:g} of the scene's {:.3g} m; {}",
      scene.name, settings.step, settings.penalty, probe.t, allowed, most, size,
      what_helps(scene.model, settings)));
}

}  // namespace

void take_probe(ReferenceSimulation& reference, const Model& model, Probe& probe) {
  reference.set_state(probe.before);
  probe.outcome = reference.step();
  reference.get_state(probe.after);
  probe.condition = reference.tangent_condition();
  probe.jacobian_norm = row_sum_norm(model, probe.before);
}

ReferenceRun run_reference(const Scene& scene, const StepSettings& settings, int most) {
  constexpr int kProbes = 5;
  most = std::clamp(400'000 / std::max(scene.model.variables(), 1), 16, most);
  ReferenceRun result;
  result.stretch = make_stretch(scene, settings.step, most, std::nullopt, settings.scheme);
  const int steps = result.stretch.steps;

  ReferenceSimulation reference(scene.model, settings);
  reference.set_state(result.stretch.initial);
  std::vector<State> probed;
  State state = result.stretch.initial;
  for (int i = 0; i < steps; ++i) {
    if (i >= (steps - 1) * static_cast<int>(probed.size()) / (kProbes - 1)) {
      probed.push_back(state);
      result.probes.push_back({result.stretch.start + i * settings.step, state, {}, {}, 0.0});
    }
    result.outcomes.push_back(reference.step());
    reference.get_state(state);
    const bool finite = std::ranges::all_of(state.q, [](double x) { return std::isfinite(x); });
    if (!finite || result.outcomes.back().status == StepStatus::factorization_failed) {
      throw UsageError(fmt::format(
          "scene '{}': the reference fails at t = {:g} s with step {:g} s and penalty {:.3g}; {}",
          scene.name, result.stretch.start + (i + 1) * settings.step, settings.step,
          settings.penalty, what_helps(scene.model, settings)));
    }
    result.positions.push_back(state.q);
    result.multipliers.push_back(state.lambda);
  }
  for (Probe& probe : result.probes) {
    take_probe(reference, scene.model, probe);
    require_judgeable(scene, settings, probe);
  }
  return result;
}

}  // namespace mbs
