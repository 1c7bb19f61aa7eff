// Negative controls: the gate rejects each defect for the right reason, and nothing else with it.
#include "controls/controls.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>
#include <regex>

#include "check/gate.hpp"
#include "run/settings.hpp"
#include "support/program.hpp"

namespace mbs {
namespace {

#if defined(__SANITIZE_ADDRESS__)
constexpr bool kSanitized = true;
constexpr double kSeconds = 15.0;  // everything is ten times slower
#else
constexpr bool kSanitized = false;
constexpr double kSeconds = 3.0;
#endif

struct Expectation {
  std::string control;
  std::string verdict;
  std::string reason;  ///< regular expression, to be found in the reason
};

/// A signal; sanitizers turn it into a report and an exit with status 1.
std::string killed(const std::string& signal) {
  return "^(killed by signal " + signal + (kSanitized ? "|exited with status 1 .*)" : ")") + "$";
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
     R"(^passes: \d+ instead of \d+ passes first at step 1 \(t = .* s\): 3 instead of 2$)"},
    {"factorization_failed", "disagrees",
     "^lock-step: factorization failed in the step from t = 0"},
    {"hangs", "timeout", R"(^did not finish within 1 s$)"},
    {"crashes", "crashed", killed(R"(11 \(Segmentation fault\))")},
    {"overflows_stack", "crashed", killed(R"(11 \(Segmentation fault\))")},
    {"divides_by_zero", "crashed", killed(R"(8 \(Floating point exception\))")},
    {"aborts", "crashed", killed(R"(6 \(Aborted\))")},
    {"allocates", "out-of-memory", "^needs more than the memory limit of 512 MiB$"},
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
  StepSettings settings = [this] {
    StepSettings result;
    result.penalty = automatic_penalty(scene.model, result.step);
    result.tolerance = automatic_tolerance(scene.model, result.step, result.penalty);
    return result;
  }();
  ReferenceRun reference = run_reference(scene, settings);
};

const Bench& bench() {
  static const Bench result;
  return result;
}

Verdict check_control(const std::string& name, const IsolationLimits& limits) {
  const Implementation implementation = test::controls();
  const auto variant = std::ranges::find(implementation.variants, name, &Variant::name);
  if (variant == implementation.variants.end()) throw std::invalid_argument(name);
  return check_implementation(bench().scene, {"control/" + name, nullptr, &*variant},
                              bench().settings, bench().reference, limits);
}

class Control : public ::testing::TestWithParam<Expectation> {};

TEST_P(Control, GetsItsVerdict) {
  const Expectation& expected = GetParam();
  if (kSanitized && expected.control == "allocates") {
    GTEST_SKIP() << "sanitizers reserve terabytes: no memory limit is set";
  }
  IsolationLimits limits{.seconds = kSeconds, .bytes = std::size_t{512} << 20};
  if (expected.control == "hangs") limits.seconds = 1.0;
  bench();
  const auto begin = std::chrono::steady_clock::now();
  const Verdict verdict = check_control(expected.control, limits);
  const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - begin;

  EXPECT_EQ(verdict.verdict, expected.verdict) << verdict.reason;
  EXPECT_TRUE(std::regex_search(verdict.reason, std::regex(expected.reason))) << verdict.reason;
  EXPECT_EQ(verdict.reason.find('\n'), std::string::npos);
  EXPECT_EQ(verdict.scene, "four-bar:10");
  EXPECT_EQ(verdict.implementation, "control/" + expected.control);
  EXPECT_LT(spent.count(), limits.seconds + 1.0);
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

}  // namespace
}  // namespace mbs
