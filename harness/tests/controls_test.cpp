// Negative controls: the gate rejects each defect for the right reason, and nothing else with it.
#include "controls/controls.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <ostream>
#include <regex>
#include <sstream>
#include <string>

#include "check/gate.hpp"
#include "run/settings.hpp"
#include "scene_file/load_scene.hpp"
#include "support/program.hpp"

namespace mbs {
namespace {

constexpr double kSeconds = 60.0;  // of what ends by itself, however busy the machine is

struct Expectation {
  std::string control;
  std::string verdict;
  std::string reason;  ///< regular expression, to be found in the reason
};

void PrintTo(const Expectation& expectation, std::ostream* stream) {
  *stream << expectation.control;
}

/// A signal; sanitizers turn it into a report and an exit with status 1.
std::string killed(const std::string& signal) {
  return "^(killed by signal " + signal + (MBS_SANITIZE ? "|exited with status 1 .*)" : ")") + "$";
}

const Expectation kExpectations[] = {
    {"reference", "agrees", "^$"},
    {"returns_at_once", "disagrees", "^lock-step: [qva] differs by .* after one step from t = "},
    {"nan_after_100", "disagrees",
     R"(^free-running: q is not finite from step 101 \(t = 0\.\d+ s\)$)"},
    {"nan_velocity", "disagrees", "^lock-step: v differs by nan after one step"},
    {"empty_state", "disagrees", "^lock-step: q differs by nan after one step"},
    {"gravity_sign", "disagrees", "^lock-step: [qva] differs by .* after one step from t = "},
    {"single_precision", "disagrees", "^lock-step: [qva] differs by .* after one step from t = "},
    {"wrong_lambda", "disagrees", "^lock-step: lambda differs by .* after one step from t = "},
    {"late_jump", "disagrees", R"(^free-running: q differs by .* m first at step 5\d\d )"},
    {"pass_count", "disagrees",
     R"(^passes: \d+ instead of \d+ passes first at step 1 \(t = .* s\): 2 instead of 1$)"},
    {"factorization_failed", "disagrees",
     "^lock-step: factorization failed in the step from t = 0"},
    {"hangs", "timeout", R"(^did not finish within 1 s$)"},
    {"crashes", "crashed", killed(R"(11 \(Segmentation fault\))")},
    {"overflows_stack", "crashed", killed(R"(11 \(Segmentation fault\))")},
    {"divides_by_zero", "crashed", killed(R"(8 \(Floating point exception\))")},
    {"aborts", "crashed", killed(R"(6 \(Aborted\))")},
    {"allocates", "out-of-memory", "^needs more than the memory limit of \\d+ MiB$"},
    {"throws", "crashed", R"(^threw the pivot\\x0Ais \\xFF nowhere$)"},
    {"throws_number", "crashed", "^threw something that is not a std::exception$"},
    {"exits", "crashed", "^exited with status 0 before its result$"},
    {"forks", "agrees", "^$"},
    {"prints", "agrees", "^$"},
    {"unsupported", "unsupported", R"(^only even numbers\\x0Aof loops$)"},
};

/// The scene and what the reference says of it, computed once.
struct Bench {
  Scene scene = load_scene("four-bar:10");
  StepSettings settings = chosen(scene.model);
  ReferenceRun reference = run_reference(scene, settings);
};

const Bench& bench() {
  static const Bench result;
  return result;
}

Verdict check_control(const std::string& name, const IsolationLimits& limits) {
  const Variant variant = test::control(name);
  return check_implementation(bench().scene, {"control/" + name, nullptr, &variant},
                              bench().settings, bench().reference, limits);
}

class Control : public ::testing::TestWithParam<Expectation> {};

TEST_P(Control, GetsItsVerdict) {
  const Expectation& expected = GetParam();
  if (MBS_SANITIZE && expected.control == "allocates") {
    GTEST_SKIP() << "sanitizers reserve terabytes: no memory limit is set";
  }
  // Most end by themselves, however busy the machine is.
  IsolationLimits limits{.seconds = expected.control == "hangs" ? 1.0 : 60.0,
                         .bytes = test::memory_of_this() + (std::size_t{512} << 20)};
  bench();
  const auto begin = std::chrono::steady_clock::now();
  const Verdict verdict = check_control(expected.control, limits);
  const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - begin;

  EXPECT_EQ(verdict.verdict, expected.verdict) << verdict.reason;
  EXPECT_TRUE(std::regex_search(verdict.reason, std::regex(expected.reason))) << verdict.reason;
  EXPECT_EQ(verdict.reason.find('\n'), std::string::npos);
  EXPECT_EQ(verdict.scene, "four-bar:10");
  EXPECT_EQ(verdict.implementation, "control/" + expected.control);
  EXPECT_LT(spent.count(), limits.seconds + 20.0);
  const bool compared = expected.verdict == "agrees" || expected.verdict == "disagrees";
  EXPECT_EQ(verdict.checks.empty(), !compared);
}

INSTANTIATE_TEST_SUITE_P(Gate, Control, ::testing::ValuesIn(kExpectations),
                         [](const auto& info) { return info.param.control; });

TEST(Controls, EachHasAnExpectation) {
  for (const Variant& variant : test::controls().variants) {
    if (variant.name == "always_converged") continue;  // see SaysSoWhenThePassLimitIsHidden
    EXPECT_EQ(std::ranges::count(kExpectations, variant.name, &Expectation::control), 1)
        << variant.name;
  }
}

TEST(Controls, SaysSoWhenThePassLimitIsHidden) {
  StepSettings settings = bench().settings;
  settings.penalty = 1e9;
  settings.max_passes = 2;
  const ReferenceRun reference = run_reference(bench().scene, settings);
  const Variant honest = test::control("reference");
  const Variant dishonest = test::control("always_converged");
  const auto check = [&](const Variant& variant) {
    return check_implementation(bench().scene, {"control", nullptr, &variant}, settings, reference,
                                {.seconds = kSeconds});
  };
  EXPECT_EQ(check(honest).reason, "");
  const Verdict verdict = check(dishonest);
  EXPECT_EQ(verdict.verdict, "disagrees");
  EXPECT_TRUE(std::regex_match(verdict.reason,
                               std::regex(R"(passes: 0 instead of \d+ steps at the pass limit)")))
      << verdict.reason;
}

/// The saddle-point form rounds q no more the larger alpha is, and its bound must not grow with it.
TEST(Controls, AreRejectedAtAnyPenaltyFactorOfTheSaddlePointForm) {
  const Scene scene = load_scene(MBS_ROOT "/harness/scenes/double_pendulum.json");
  for (const double penalty : {0.0, 1e25, 1e28}) {
    const StepSettings settings =
        chosen(scene.model, {.penalty = penalty, .scheme = Scheme::saddle_point});
    const ReferenceRun reference = run_reference(scene, settings, 16);
    for (const char* name : {"reference", "single_precision"}) {
      Variant variant = test::control(name);
      variant.serves = test::reference().serves;
      const Verdict verdict =
          check_in_process(scene, {name, nullptr, &variant}, settings, reference, kSeconds);
      EXPECT_EQ(verdict.agrees(), variant.name == "reference") << penalty << name << verdict.reason;
    }
  }
}

/// Number of lines of `text` on which `expression` is found.
long lines_with(const std::string& text, const std::string& expression) {
  const std::regex regex(expression);
  std::istringstream lines(text);
  long count = 0;
  for (std::string line; std::getline(lines, line);) count += std::regex_search(line, regex);
  return count;
}

TEST(ControlsProgram, GivesEachImplementationItsVerdict) {
  const std::string file = test::temporary_path("verdicts.json");
  std::string arguments =
      "check four-bar:10 --time-limit " + std::to_string(kSeconds) + " --json '" + file + "'";
  const std::string controls[] = {"returns_at_once", "crashes",       "reference", "exits",
                                  "prints",          "nan_after_100", "throws",    "unsupported"};
  for (const std::string& name : controls) arguments += " --implementation control/" + name;
  const auto run = test::run_program(MBS_CONTROLS, arguments);
  EXPECT_EQ(run.status, 1);
  for (const std::string& name : controls) {
    const auto expected = std::ranges::find(kExpectations, name, &Expectation::control);
    const std::string line = "^four-bar:10 +control/" + name + " +" + expected->verdict;
    EXPECT_EQ(lines_with(run.output, line), 1) << run.output;
  }
  EXPECT_EQ(lines_with(run.output, "^2 of 7 agree with the reference .unsupported: 1.$"), 1)
      << run.output;
  EXPECT_EQ(lines_with(run.output, "was here"), 0);
  if (!MBS_SANITIZE) {
    EXPECT_EQ(run.errors, "");
  }
  const auto rows = nlohmann::json::parse(test::file_text(file)).at("rows");
  EXPECT_EQ(rows.size(), std::size(controls));
  std::filesystem::remove(file);
}

TEST(ControlsProgram, HangingAndHungryOnesDoNotStopTheOthers) {
  if (MBS_SANITIZE) GTEST_SKIP() << "sanitizers reserve terabytes: no memory limit is set";
  // On a busy machine the others need more time than the one that hangs deserves: a second try.
  test::ProgramResult run;
  std::string limit;
  for (const char* seconds : {"2", "20"}) {
    limit = seconds;
    run = test::run_program(MBS_CONTROLS,
                            "check four-bar:10 --time-limit " + limit +
                                " --implementation control/hangs --implementation "
                                "control/allocates --implementation control/reference",
                            "ulimit -v 500000;");
    if (lines_with(run.output, "out-of-memory|agrees$") == 2) break;
  }
  EXPECT_EQ(run.status, 1);
  EXPECT_EQ(
      lines_with(run.output, "control/hangs +timeout: did not finish within " + limit + " s$"), 1)
      << run.output;
  EXPECT_EQ(
      lines_with(run.output,
                 "control/allocates +out-of-memory: needs more than the memory limit of 488 MiB$"),
      1);
  EXPECT_EQ(lines_with(run.output, "control/reference +agrees$"), 1);
  EXPECT_EQ(run.errors, "");
}

TEST(ControlsProgram, SucceedsOnlyIfAllAgree) {
  const std::string check = "check four-bar:10 --time-limit 20 --implementation control/";
  EXPECT_EQ(test::run_program(MBS_CONTROLS, check + "reference").status, 0);
  EXPECT_EQ(test::run_program(MBS_CONTROLS, check + "pass_count").status, 1);
}

/// Large N, where positions no longer tell: rounding of lambda must not hide that it never moves.
TEST(ControlsProgram, WrongMultipliersAreRejectedAtEverySizeThatShowsThem) {
  for (const char* scene : {"four-bar:160", "four-bar:499"}) {
    if (MBS_SANITIZE && scene == std::string("four-bar:499")) continue;  // the gate is slow there
    const auto run = test::run_program(
        MBS_CONTROLS, std::string("check ") + scene + " --implementation control/wrong_lambda");
    EXPECT_EQ(run.status, 1) << run.output;
  }
}

TEST(ControlsProgram, BenchKeepsTheRowOfTheOneThatFails) {
  const std::string file = test::temporary_path("bench.json");
  const auto run = test::run_program(
      MBS_CONTROLS,
      "bench four-bar:2 --implementation control/nan_after_100 --implementation control/reference "
      "--steps 120 --benchmark_min_time=0 --benchmark_repetitions=1 --benchmark_out='" +
          file + "'");
  EXPECT_EQ(run.status, 1) << run.errors;
  const auto rows = nlohmann::json::parse(test::file_text(file)).at("benchmarks");
  std::filesystem::remove(file);
  ASSERT_EQ(rows.size(), 2U);  // in any order
  for (const auto& row : rows) {
    if (row.at("name") == "control/reference/four-bar:2") {
      EXPECT_FALSE(row.contains("error_occurred"));
      continue;
    }
    EXPECT_EQ(row.at("name"), "control/nan_after_100/four-bar:2");
    EXPECT_EQ(row.at("error_occurred"), true);
    const std::regex message("diverged: the state is not finite at .* s, the end of the stretch");
    EXPECT_TRUE(std::regex_match(row.at("error_message").get<std::string>(), message)) << row;
  }
}

TEST(ControlsProgram, SimulateNeverCallsNanOk) {
  const auto run = test::run_program(
      MBS_CONTROLS,
      "simulate four-bar:2 --implementation control/nan_after_100 --duration 1 --json "
      "--judge-every 1");
  EXPECT_EQ(run.status, 1);
  const auto summary = nlohmann::json::parse(run.output);
  EXPECT_EQ(summary.at("status"), "diverged");
  EXPECT_EQ(summary.at("status_reason"), "the state is not finite");
  EXPECT_EQ(summary.at("steps"), 101);
  EXPECT_NEAR(summary.at("failed_at").get<double>(), 101 * 1.25e-3, 1e-12);
  for (const char* figure :
       {"position_error_max", "energy_drift_max", "constraint_violation_max"}) {
    EXPECT_TRUE(summary.at(figure).is_null()) << figure;
  }
  EXPECT_EQ(run.errors,
            "mbs: control/nan_after_100 on four-bar:2: diverged at t = 0.12625 s: the state is not "
            "finite (a shorter --step may help)\n");
}

}  // namespace
}  // namespace mbs
