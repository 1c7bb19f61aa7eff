// Rungs in order; each is a function that a child process runs.
#include "ladder/ladder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "check/gate.hpp"
#include "check/lock_step.hpp"
#include "ladder/term_models.hpp"
#include "printable.hpp"
#include "registry/factory.hpp"
#include "registry/setting_names.hpp"
#include "run/initial_state.hpp"
#include "run/settings.hpp"
#include "scene_file/load_scene.hpp"

namespace mbs {
namespace {

constexpr const char* kSmallest = "four-bar:1";

/// The usual reasons why a check of the gate fails where single steps are right.
struct GateLesson {
  const char* check;
  std::vector<std::string> mistakes;
};

std::vector<std::string> gate_mistakes(const std::string& check) {
  static const std::vector<GateLesson> lessons{
      {"lock-step",
       {"the pass that converges, or that is the last, does not update lambda",
        "do_set_state() leaves something of earlier steps behind: lambda, a time, kept factors",
        "Newton ends too early or too late: it ends after the pass whose max |Delta q| <= "
        "tolerance",
        "a later pass uses the Phi_q or T of an earlier one, or projects before the last pass"}},
      {"free-running",
       {"something is carried from step to step that do_get_state() does not show",
        "a step at the pass limit is repeated, left out or reported as a failure"}},
      {"passes",
       {"Newton ends by another norm than max |Delta q|, or relative to q",
        "at the pass limit the status is pass_limit, passes is max_passes"}},
      {"multipliers", {"lambda is not updated in the pass that converges"}},
      {"batch", {"a lane reads numbers of another: masses, lengths, penalty factors"}},
      {"batch-running", {"a lost or retired lane disturbs the others"}},
  };
  for (const GateLesson& lesson : lessons) {
    if (check == lesson.check) return lesson.mistakes;
  }
  return {};
}

/// Goes up; knows whether it may go on.
class Climber {
 public:
  Climber(const NamedVariant& variant, const IsolationLimits& limits,
          const std::function<void(const RungReport&)>& done)
      : variant_(variant), limits_(limits), done_(done) {}

  void climb() {
    const Scene smallest = load_scene(kSmallest);
    for (const StepRung& rung : step_rungs()) {
      RungReport report = start(rung.name, smallest.name);
      look(report, rung, smallest.model, chosen(smallest.model), "");
      if (!finish(report)) return;
    }
    if (!finish(ten_steps(smallest))) return;
    for (const auto& [rung, scene] :
         {std::pair("the stretch", kSmallest), std::pair("more loops", "four-bar:10"),
          std::pair("fill", "four-bar:10,fill=0.6")}) {
      if (!finish(gate(rung, load_scene(scene), {}))) return;
    }
    for (const TermModel& term : term_models()) {
      if (!finish(one_term(term))) return;
    }
    for (const Projections projections : {Projections::none, Projections::velocity}) {
      if (!finish(one_setting({.projections = projections}))) return;
    }
    for (const SettingCase& setting : setting_cases()) {
      if (!finish(one_setting(setting.settings))) return;
    }
  }

 private:
  RungReport start(std::string rung, std::string scene) const {
    RungReport report;
    report.implementation = variant_.name;
    report.rung = std::move(rung);
    report.scene = std::move(scene);
    return report;
  }

  bool finish(const RungReport& report) const {
    done_(report);
    return report.result != RungResult::failed;
  }

  /// Runs `work`, which fills in a report, in a child; what becomes of the child goes into
  /// `report`.
  void isolated(RungReport& report, const std::function<void(RungReport&)>& work) const {
    const Isolated child = run_isolated(
        [&]() -> std::string {
          RungReport inner = report;
          try {
            work(inner);
          } catch (const Unsupported& reason) {
            inner.result = RungResult::not_served;
            inner.detail = printable(reason.what(), 1000);
          }
          return nlohmann::json(inner).dump();
        },
        limits_);
    if (child.fate == Fate::finished) {
      read(nlohmann::json::parse(child.output), report);
      return;
    }
    report.result = RungResult::failed;
    report.detail = (child.fate == Fate::threw ? "threw " : "") + child.reason;
    report.mistakes.clear();
    if (child.fate == Fate::timeout) {
      report.mistakes = {"a loop has no end: passes end at max_passes, also with a NaN"};
    } else if (child.fate == Fate::crashed) {
      report.mistakes = {
          "an index is out of range, or a vector was not given its size: a build with "
          "sanitizers names the line (CMakePresets.json)"};
    }
  }

  static void read(const nlohmann::json& json, RungReport& report);

  /// One rung of a step; `options` are those of `mbs reference` beside --moved.
  void look(RungReport& report, const StepRung& rung, const Model& model,
            const StepSettings& settings, const std::string& options) const {
    const State state = moved_state(model, initial_state(model), settings.penalty);
    report.equation = rung.equation;
    report.mistakes = rung.mistakes;
    report.command = fmt::format("mbs reference '{}'{} --moved", report.scene, options);
    isolated(report, [&](RungReport& inner) {
      const auto make = [&](const StepSettings& one) {
        return create_simulation(*variant_.variant, model, one);
      };
      const Compared compared = compare_step(rung, make, model, settings, state);
      inner.result = compared.finding     ? RungResult::failed
                     : !compared.is_shown ? RungResult::not_yet
                                          : RungResult::ok;
      if (compared.finding) inner.finding = *compared.finding;
    });
  }

  RungReport ten_steps(const Scene& scene) const;
  RungReport gate(const std::string& rung, const Scene& scene, StepSettings settings) const;
  RungReport one_term(const TermModel& term) const;
  RungReport one_setting(const StepSettings& settings) const;
  void judge(RungReport& report, const Scene& scene, const StepSettings& settings) const;

  const NamedVariant& variant_;
  IsolationLimits limits_;
  const std::function<void(const RungReport&)>& done_;
};

/// Ten steps in a row, without set_state() in between.
RungReport Climber::ten_steps(const Scene& scene) const {
  constexpr int kSteps = 10;
  const StepSettings settings = chosen(scene.model);
  RungReport report = start("ten steps", scene.name);
  report.equation = "\"The step\"";
  report.mistakes = {
      "the pass that converges does not correct q' or update lambda: it does both, then Newton "
      "ends",
      "a step begins from the predicted state of the one before, or from v and a before projection",
      "lambda starts from zero in every step"};
  isolated(report, [&](RungReport& inner) {
    const auto simulation = create_simulation(*variant_.variant, scene.model, settings);
    ReferenceSimulation reference(scene.model, settings), probing(scene.model, settings);
    Probe probe{0.0, initial_state(scene.model), {}, {}, 0.0};
    simulation->set_state(probe.before);
    reference.set_state(probe.before);
    State ours, expected;
    for (int step = 1; step <= kSteps; ++step) {
      take_probe(probing, scene.model, probe);
      const LockStepTolerance once = lock_step_tolerance(probe, settings);
      const StepOutcome outcome = simulation->step(), right = reference.step();
      simulation->get_state(ours);
      reference.get_state(expected);
      inner.command = fmt::format("mbs reference {} --after {}", scene.name, step - 1);
      const auto differs = [&](const char* name, const std::vector<double>& x,
                               const std::vector<double>& y, double allowed) {
        const auto finding = compare_values(scene.model, name, x, y, 10 * step * allowed);
        if (!finding) return false;
        inner.result = RungResult::failed;
        inner.finding = *finding;
        inner.detail = fmt::format("in step {} of {}", step, kSteps);
        return true;
      };
      if (differs("q", ours.q, expected.q, once.q) || differs("v", ours.v, expected.v, once.v) ||
          differs("a", ours.a, expected.a, once.a) ||
          differs("lambda", ours.lambda, expected.lambda, once.lambda)) {
        return;
      }
      if (outcome.passes != right.passes || outcome.status != right.status) {
        inner.result = RungResult::failed;
        const auto limited = [](const StepOutcome& one) {
          return one.status == StepStatus::pass_limit ? "pass_limit" : "converged";
        };
        inner.finding = {"passes", "", static_cast<double>(outcome.passes),
                         static_cast<double>(right.passes),
                         fmt::format("{} instead of {}", limited(outcome), limited(right))};
        inner.detail = fmt::format("in step {} of {}", step, kSteps);
        return;
      }
      probe = {expected.t, expected, {}, {}, 0.0};
    }
  });
  if (report.result != RungResult::failed) report.command.clear();
  return report;
}

/// The gate on a scene, as `mbs check` runs it.
void Climber::judge(RungReport& report, const Scene& scene, const StepSettings& settings) const {
  const std::string unsuited = why_unsuited(scene.model, settings);
  if (!unsuited.empty()) {
    report.result = RungResult::not_served;
    report.detail = unsuited;
    return;
  }
  const Verdict verdict =
      check_implementation(scene, variant_, settings, run_reference(scene, settings), limits_);
  if (verdict.agrees()) return;
  report.detail = verdict.reason;
  report.result = verdict.verdict == "unsupported" ? RungResult::not_served : RungResult::failed;
  const auto failed = std::ranges::find(verdict.checks, std::optional(false), &Check::passed);
  if (failed == verdict.checks.end()) return;
  report.finding = {"check " + failed->name,
                    "",
                    failed->value,
                    {},
                    failed->tolerance ? fmt::format("{:.3g} is allowed", *failed->tolerance) : ""};
  report.mistakes = gate_mistakes(failed->name);
}

RungReport Climber::gate(const std::string& rung, const Scene& scene, StepSettings settings) const {
  RungReport report = start(rung, scene.name);
  settings = chosen(scene.model, settings);
  report.equation = "\"The step\"";
  const std::string others = other_settings(settings);
  report.command = fmt::format("mbs check {} --implementation {}{}{}", scene.name, variant_.name,
                               others.empty() ? "" : " ", others);
  // What is not served is said without running the reference.
  const std::string refused = why_not_served(variant_.variant->serves, scene.model, settings);
  if (refused.empty()) {
    judge(report, scene, settings);
  } else {
    report.result = RungResult::not_served;
    report.detail = refused;
  }
  return report;
}

RungReport Climber::one_setting(const StepSettings& settings) const {
  RungReport report = gate(other_settings(settings), load_scene("four-bar:2"), settings);
  report.equation = "paper/other_schemes.md";
  if (report.result == RungResult::failed) {
    report.mistakes.insert(report.mistakes.begin(), "the step does not look at the setting");
  }
  return report;
}

/// The rungs of a step with the term, then the gate.
RungReport Climber::one_term(const TermModel& term) const {
  RungReport report = start(term.name, term.name);
  const std::string refused = why_not_served(variant_.variant->serves.terms, term.model);
  if (!refused.empty()) {
    report.result = RungResult::not_served;
    report.detail = refused;
    return report;
  }
  const StepSettings settings = term_settings(term.model);
  for (const StepRung& rung : step_rungs()) {
    look(report, rung, term.model, settings, fmt::format(" --step {:g}", settings.step));
    report.equation += "; of the term: " + term.equation;
    if (report.result == RungResult::not_yet) report.result = RungResult::ok;
    if (report.result != RungResult::ok) return report;
  }
  report.equation = term.equation;
  report.mistakes.clear();
  judge(report, {term.name, term.model, {}, {}}, settings);
  return report;
}

void Climber::read(const nlohmann::json& json, RungReport& report) {
  const auto number = [](const nlohmann::json& value) {
    return value.is_null() ? std::nullopt : std::optional(value.get<double>());
  };
  for (const RungResult result :
       {RungResult::ok, RungResult::not_yet, RungResult::not_served, RungResult::failed}) {
    if (json.at("result") == name_of(result)) report.result = result;
  }
  report.detail = json.at("detail").get<std::string>();
  report.command = json.at("command").get<std::string>();
  report.finding = {json.at("quantity").get<std::string>(), json.at("row").get<std::string>(),
                    number(json.at("value")), number(json.at("reference")),
                    json.at("differs").get<std::string>()};
}

}  // namespace

const char* name_of(RungResult result) {
  switch (result) {
    case RungResult::ok:
      return "ok";
    case RungResult::not_yet:
      return "not yet";
    case RungResult::not_served:
      return "not served";
    case RungResult::failed:
      return "FAILED";
  }
  return "";
}

void to_json(nlohmann::json& json, const RungReport& report) {
  const auto nullable = [](const std::optional<double>& x) {
    return x ? nlohmann::json(*x) : nlohmann::json();
  };
  json = {{"implementation", report.implementation},
          {"rung", report.rung},
          {"scene", report.scene},
          {"result", name_of(report.result)},
          {"detail", report.detail},
          {"quantity", report.finding.quantity},
          {"row", report.finding.row},
          {"value", nullable(report.finding.value)},
          {"reference", nullable(report.finding.reference)},
          {"differs", report.finding.detail},
          {"equation", report.equation},
          {"mistakes", report.mistakes},
          {"command", report.command}};
}

void climb(const NamedVariant& variant, const IsolationLimits& limits,
           const std::function<void(const RungReport&)>& done) {
  Climber(variant, limits, done).climb();
}

}  // namespace mbs
