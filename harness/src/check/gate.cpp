// Each check is one function; the child process runs them in order of growing cost.
#include "check/gate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "check/batch_checks.hpp"
#include "check/exact_checks.hpp"
#include "check/lock_step.hpp"
#include "check/processor_time.hpp"
#include "model_math/extent.hpp"
#include "printable.hpp"
#include "registry/factory.hpp"

namespace mbs {
namespace {

using Values = std::vector<double>;

/// The time was over before there was enough to judge.
struct OutOfTime : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// One step from the state of each probe; value = worst difference in units of its tolerance.
Check lock_step(const NamedVariant& variant, const Model& model, const StepSettings& settings,
                const ReferenceRun& reference) {
  const auto simulation = create_simulation(*variant.variant, model, settings);
  LockStep comparison("lock-step");
  State state;
  for (const Probe& probe : reference.probes) {
    simulation->set_state(probe.before);
    const StepOutcome outcome = simulation->step();
    simulation->get_state(state);
    comparison.add(probe, settings, outcome, state);
  }
  return comparison.check();
}

/// lambda after `steps` steps of the stretch against the reference's: within 5 % of the way that it
/// has moved since the start, beyond `noise` (N/m), what rounding does to it in one step. Positions
/// hardly depend on lambda, so they cannot judge it. Where the noise may hide that it never moves,
/// nothing is said for it.
Check compare_multipliers(const ReferenceRun& reference, const Values& lambda, std::size_t steps,
                          double noise) {
  if (lambda.empty() || steps == 0) return {"multipliers", {}, {}, {}, "there are none"};
  const Values& expected = reference.multipliers[steps - 1];
  const double moved = largest_difference(expected, reference.stretch.initial.lambda);
  const double difference = largest_difference(lambda, expected);
  const double allowed = 0.05 * moved + noise;
  std::optional<bool> passed = difference <= allowed;
  if (*passed && !(noise <= moved / 2)) passed.reset();
  return {"multipliers", difference, allowed, passed,
          fmt::format("N/m; they moved by {:.1e}, rounding is up to {:.1e}", moved, noise)};
}

/// Runs the stretch, or what `seconds` allow of it; compares positions and passes with the
/// reference's after every step. Throws OutOfTime after fewer than 16 steps that agree.
std::vector<Check> free_running(const NamedVariant& variant, const Model& model,
                                const StepSettings& settings, const ReferenceRun& reference,
                                double seconds) {
  const auto allowed =
      free_running_tolerance(reference.probes.back(), settings, extent(model.points()));
  const auto simulation = create_simulation(*variant.variant, model, settings);
  simulation->set_state(reference.stretch.initial);
  const double h = settings.step;
  const auto time = [&](std::size_t i) { return reference.stretch.start + (i + 1.0) * h; };
  Check positions{"free-running", 0.0, allowed.q, true, ""};
  Check passes{"passes", 0.0, 0.0, true, ""};
  Check multipliers{"multipliers", {}, {}, {}, "positions differ"};
  long total = 0, expected = 0;
  long limited = 0, expected_limited = 0;
  State state;
  std::size_t done = 0;
  const double end = processor_seconds() + seconds;
  for (std::size_t i = 0; i < reference.positions.size(); ++i) {
    if (processor_seconds() > end) break;
    ++done;
    const StepOutcome outcome = simulation->step();
    simulation->get_state(state);
    total += outcome.passes;
    expected += reference.outcomes[i].passes;
    limited += outcome.status == StepStatus::pass_limit;
    expected_limited += reference.outcomes[i].status == StepStatus::pass_limit;
    const double difference = largest_difference(state.q, reference.positions[i]);
    positions.value = std::isnan(difference) ? difference : std::max(*positions.value, difference);
    if (!(difference <= allowed.q)) {
      positions.passed = false;
      positions.detail =
          std::isnan(difference)
              ? fmt::format("q is not finite from step {} (t = {:g} s)", i + 1, time(i))
              : fmt::format("q differs by {:.1e} m first at step {} (t = {:g} s)", difference,
                            i + 1, time(i));
      break;
    }
    if (outcome.passes != reference.outcomes[i].passes && passes.detail.empty()) {
      passes.detail = fmt::format("first at step {} (t = {:g} s): {} instead of {}", i + 1, time(i),
                                  outcome.passes, reference.outcomes[i].passes);
    }
  }
  const std::size_t least = std::min<std::size_t>(16, reference.positions.size());
  if (*positions.passed) {
    if (done < least) {
      throw OutOfTime(fmt::format("free-running: {} steps, which agree, in {:.2g} s; it takes {} to judge: a longer --time-limit",
                                  done, seconds, least));
    }
    multipliers =
        allowed.multipliers
            ? compare_multipliers(reference, state.lambda, done,
                                  lock_step_tolerance(reference.probes.back(), settings).lambda)
            : Check{"multipliers", {}, {}, {}, "rounding drowns them"};
    positions.detail = fmt::format("m; {} of {} steps from t = {:g} s", done,
                                   reference.positions.size(), reference.stretch.start);
  }
  if (settings.precision != Precision::double_precision) {
    passes = {"passes", {}, {}, {}, "with factors in single precision rounding decides on them"};
    return {positions, passes, multipliers};
  }
  passes.value = static_cast<double>(std::abs(total - expected));
  passes.tolerance = std::floor(allowed.passes * static_cast<double>(expected));
  passes.passed = *passes.value <= *passes.tolerance;
  passes.detail = total == expected
                      ? fmt::format("{} passes in total", total)
                      : fmt::format("{} instead of {} passes {}", total, expected, passes.detail);
  const double limit_differs = static_cast<double>(std::abs(limited - expected_limited));
  if (*passes.passed && limit_differs > *passes.tolerance) {
    passes = {"passes", limit_differs, passes.tolerance, false,
              fmt::format("{} instead of {} steps at the pass limit", limited, expected_limited)};
  }
  return {positions, passes, multipliers};
}

std::vector<Check> run_checks(const Scene& scene, const NamedVariant& variant,
                              const StepSettings& settings, const ReferenceRun& reference,
                              double seconds) {
  std::vector<Check> checks{lock_step(variant, scene.model, settings, reference)};
  const double begin = processor_seconds();
  std::ranges::copy(free_running(variant, scene.model, settings, reference, seconds / 4),
                    std::back_inserter(checks));
  const bool sound = std::ranges::all_of(checks, [](const Check& c) { return c.passed != false; });
  if (sound && scene.four_bar_loops) {
    const bool affordable =
        processor_seconds() - begin < seconds / 16;  // about twice as much is to come
    std::ranges::copy(affordable ? exact_checks(scene, *variant.variant, settings)
                                 : exact_checks_not_run("it would take too long here"),
                      std::back_inserter(checks));
  }
  if (variant.variant->create_batch != nullptr) {
    std::ranges::copy(batch_checks(*variant.variant, scene.model, settings, reference, seconds / 8),
                      std::back_inserter(checks));
  }
  return checks;
}

Verdict interpret(Verdict verdict, const Isolated& result) {
  verdict.reason = result.reason;
  switch (result.fate) {
    case Fate::finished: {
      auto found = nlohmann::json::parse(result.output).get<Verdict>();
      found.scene = verdict.scene;
      found.implementation = verdict.implementation;
      return found;
    }
    case Fate::crashed:
      verdict.verdict = "crashed";
      break;
    case Fate::timeout:
      verdict.verdict = "timeout";
      break;
    case Fate::out_of_memory:
      verdict.verdict = "out-of-memory";
      break;
    case Fate::threw:
      verdict.verdict = "crashed";
      verdict.reason = "threw " + result.reason;
      break;
  }
  return verdict;
}

}  // namespace

Verdict check_in_process(const Scene& scene, const NamedVariant& variant,
                         const StepSettings& settings, const ReferenceRun& reference,
                         double seconds) {
  Verdict verdict{scene.name, variant.name, "agrees", "", {}};
  try {
    verdict.checks = run_checks(scene, variant, settings, reference, seconds);
  } catch (const Unsupported& reason) {
    verdict.verdict = "unsupported";
    verdict.reason = printable(reason.what(), 1000);
  } catch (const OutOfTime& reason) {
    verdict.verdict = "timeout";
    verdict.reason = reason.what();
  }
  const auto failed = std::ranges::find(verdict.checks, std::optional(false), &Check::passed);
  if (failed != verdict.checks.end()) {
    verdict.verdict = "disagrees";
    verdict.reason = failed->name + ": " + failed->detail;
  }
  return verdict;
}

Verdict check_implementation(const Scene& scene, const NamedVariant& variant,
                             const StepSettings& settings, const ReferenceRun& reference,
                             const IsolationLimits& limits) {
  const auto work = [&] {
    Verdict found = check_in_process(scene, variant, settings, reference, limits.seconds);
    found.scene = found.implementation = "";  // they may be no UTF-8
    return nlohmann::json(found).dump();
  };
  return interpret({scene.name, variant.name, "", "", {}}, run_isolated(work, limits));
}

}  // namespace mbs
