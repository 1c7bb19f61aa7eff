// The parts of `mbs bench`: what is planned, what is timed, and how failures are told.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>
#include <numeric>

#include "bench/bench_plan.hpp"
#include "bench/measurement.hpp"
#include "bench/null_variant.hpp"
#include "bench/reporters.hpp"
#include "exact/four_bar_exact.hpp"
#include "run/settings.hpp"
#include "scene_file/load_scene.hpp"
#include "support/scripted_simulation.hpp"
#include "usage_error.hpp"

namespace mbs {
namespace {

using test::create_scripted;
using test::Scripted;

/// A cell on a four-bar over ten steps that are so short that standing still is no divergence.
class MeasurementTest : public ::testing::Test {
 protected:
  Measurement measurement(decltype(Variant::create) create, bool phases = false) {
    variant_ = {"scripted", "", create};
    Scripted::steps = Scripted::starts = 0;
    return Measurement({scene_, variant_, stretch_, settings_, false, phases});
  }
  std::string failure(decltype(Variant::create) create) {
    Measurement cell = measurement(create);
    try {
      cell.prepare();
    } catch (...) {
      return failure_text();
    }
    return "";
  }

  const Scene scene_ = load_scene("four-bar:2");
  const StepSettings settings_{1e-7, 1e8, 1e-9, 20};
  const Stretch stretch_ = make_stretch(scene_, settings_.step, 10, 0.0);
  Variant variant_;
};

using Script = Scripted::Script;

TEST_F(MeasurementTest, TimesWholeStretchesFromTheSameState) {
  Measurement cell = measurement(create_scripted<Script::still>);
  cell.prepare();
  EXPECT_EQ(Scripted::steps, 10) << "one warm-up stretch";
  EXPECT_EQ(Scripted::starts, 6) << "five set-ups and the warm-up";
  cell.time_stretch();
  EXPECT_EQ(Scripted::steps, 20);
  EXPECT_EQ(Scripted::starts, 7);
  EXPECT_EQ(cell.figures().passes, 20);
  EXPECT_EQ(cell.figures().steps_at_limit, 0);
  EXPECT_TRUE(cell.figures().position_error.has_value());
  EXPECT_FALSE(cell.figures().phases.has_value());
}

TEST_F(MeasurementTest, KeepsSetUpOutOfTheStretch) {
  Measurement cell = measurement(create_scripted<Script::slow_setup>);
  cell.prepare();
  EXPECT_GE(cell.figures().setup_us, 8000.0);
  double fastest = 1.0;  // another process may take its share: several tries
  for (int i = 0; i < 100 && fastest >= 2e-3; ++i) fastest = std::min(fastest, cell.time_stretch());
  EXPECT_LT(fastest, 2e-3);
  EXPECT_GT(fastest, 0.0);
}

TEST_F(MeasurementTest, TimesTheStepsThemselves) {
  Measurement cell = measurement(create_scripted<Script::phases>);
  cell.prepare();
  EXPECT_GE(cell.time_stretch(), 10 * 80e-6);
}

TEST_F(MeasurementTest, SharesTimeByPhase) {
  // Three parts of four are spent on solving, but another process may take its share: stretches far shorter
  // than what it is given at a time, and several tries.
  bool as_scripted = false;
  for (int attempt = 0; attempt < 100 && !as_scripted; ++attempt) {
    Measurement cell = measurement(create_scripted<Script::phases>, true);
    cell.prepare();
    ASSERT_TRUE(cell.figures().phases.has_value());
    const auto& shares = *cell.figures().phases;
    EXPECT_NEAR(std::accumulate(shares.begin(), shares.end(), 0.0), 1.0, 1e-12);
    EXPECT_EQ(shares[static_cast<std::size_t>(Phase::evaluation)], 0.0);
    EXPECT_EQ(shares[static_cast<std::size_t>(Phase::assembly)], 0.0);
    EXPECT_EQ(shares[static_cast<std::size_t>(Phase::factorization)], 0.0);
    as_scripted = std::abs(shares[static_cast<std::size_t>(Phase::solve)] - 0.75) < 0.1 &&
                  std::abs(shares[static_cast<std::size_t>(Phase::projection)] - 0.25) < 0.1;
  }
  EXPECT_TRUE(as_scripted);
}

TEST_F(MeasurementTest, CountsStepsAtTheLimit) {
  Measurement cell = measurement(create_scripted<Script::at_limit>);
  cell.prepare();
  EXPECT_EQ(cell.figures().steps_at_limit, 5);
  EXPECT_EQ(cell.figures().passes, 5 * 2 + 5 * 20);
}

TEST_F(MeasurementTest, SaysWhatTheSimulationHolds) {
  if (MBS_SANITIZE) GTEST_SKIP() << "the sanitizer's malloc does not tell";
  Measurement cell = measurement(create_scripted<Script::hoards>);
  cell.prepare();
  EXPECT_GE(cell.figures().memory_bytes, 8e6);
  EXPECT_LE(cell.figures().memory_bytes, 8.1e6);
}

TEST_F(MeasurementTest, GoesOnInPieces) {
  Measurement cell = measurement(create_scripted<Script::at_limit>);
  cell.prepare();
  cell.start();
  Spent spent;
  for (const int steps : {3, 6, 1}) spent += cell.advance(steps);
  EXPECT_EQ(Scripted::starts, 7) << "one start for all pieces";
  EXPECT_EQ(cell.figures().steps_at_limit, 5);
  EXPECT_EQ(cell.figures().passes, 5 * 2 + 5 * 20);
  EXPECT_GT(spent.seconds, 0.0);
}

TEST_F(MeasurementTest, NamesEveryKindOfFailure) {
  EXPECT_EQ(failure([](const Model&, const StepSettings&) -> std::unique_ptr<Simulation> {
              throw Unsupported("only three dimensions");
            }),
            "unsupported: only three dimensions");
  EXPECT_EQ(failure([](const Model&, const StepSettings&) -> std::unique_ptr<Simulation> {
              throw std::bad_alloc();
            }),
            "out-of-memory: an allocation failed");
  EXPECT_EQ(failure([](const Model&, const StepSettings&) -> std::unique_ptr<Simulation> {
              throw std::runtime_error("something else");
            }),
            "error: something else");
  EXPECT_EQ(failure([](const Model&, const StepSettings&) -> std::unique_ptr<Simulation> {
              throw std::runtime_error("two\nlines");
            }),
            "error: two\\x0Alines");
  EXPECT_EQ(failure(create_scripted<Script::throws_number>),
            "error: it threw what is no std::exception");
  EXPECT_EQ(failure(create_scripted<Script::refuses>),
            "factorization-failed: the tangent of step 4 of 10 was refused");
  EXPECT_TRUE(
      failure(create_scripted<Script::not_finite>).starts_with("diverged: the state is not"))
      << failure(create_scripted<Script::not_finite>);
}

TEST_F(MeasurementTest, RefusesAMotionThatIsLost) {
  const StepSettings settings{1e-3, 1e8, 1e-9, 20};
  const Stretch stretch = make_stretch(scene_, settings.step, 400, 0.0);
  Variant variant{"scripted", "", create_scripted<Script::still>};
  Measurement still({scene_, variant, stretch, settings, false, false});
  EXPECT_THROW(still.prepare(), CellFailure) << "0.4 s of standing still";
  Measurement control({scene_, null_variant(), stretch, settings, true, false});
  EXPECT_NO_THROW(control.prepare());
  EXPECT_FALSE(control.figures().position_error.has_value());
  EXPECT_EQ(control.figures().passes, 400);
}

BenchRequest request() {
  BenchRequest result;
  result.settings = [](const Model& model) { return chosen(model); };
  return result;
}

TEST(BenchPlan, DefaultsToTwoScenesAllVariantsAndTheControl) {
  const BenchPlan plan = plan_bench(request());
  const auto is_timed = [](const NamedVariant& one) {
    return one.entry->implementation.role != Role::example;
  };
  ASSERT_EQ(plan.cells.size(), 2 * (std::ranges::count_if(all_variants(), is_timed) + 1));
  EXPECT_EQ(plan.cells.front().name, "null/null/four-bar:10");
  EXPECT_TRUE(plan.cells.front().control);
  for (const PlannedCell& cell : plan.cells) {
    EXPECT_TRUE(cell.name.ends_with(cell.scene->scene.name));
    EXPECT_EQ(cell.control, cell.name.starts_with("null/"));
  }
}

TEST(BenchPlan, TakesWhatWasTriedOnlyByItsFullName) {
  if (tried_variants().empty()) GTEST_SKIP() << "no variant was tried for another";
  const NamedVariant tried = tried_variants().front();
  BenchRequest named = request();
  named.scenes = {"four-bar:1"};
  named.implementations = {tried.name};
  ASSERT_EQ(plan_bench(named).cells.size(), 1U);
  EXPECT_EQ(plan_bench(named).cells.front().variant, tried.variant);
  named.implementations = {tried.entry->folder};
  const BenchPlan folder = plan_bench(named);
  EXPECT_TRUE(std::ranges::none_of(
      folder.cells, [&](const PlannedCell& cell) { return cell.variant == tried.variant; }));
}

TEST(BenchPlan, ATwinIsASecondInstanceOfItsVariant) {
  if (all_variants().empty()) GTEST_SKIP() << "no implementation is available";
  const NamedVariant first = all_variants().front();
  BenchRequest twice = request();
  twice.scenes = {"four-bar:1"};
  twice.implementations = {first.name, first.name + "+twin"};
  const BenchPlan plan = plan_bench(twice);
  ASSERT_EQ(plan.cells.size(), 2U);
  EXPECT_EQ(plan.cells[0].name, first.name + "/four-bar:1");
  EXPECT_EQ(plan.cells[1].name, first.name + "+twin/four-bar:1");
  EXPECT_EQ(plan.cells[1].variant, first.variant);
  twice.implementations = {"nobody+twin"};
  EXPECT_THROW(plan_bench(twice), UsageError);
}

TEST(BenchPlan, CentresTheStretchOnTheSingularPosition) {
  for (const int loops : {1, 10, 40, kMostLoopsToCross}) {
    BenchRequest one = request();
    one.scenes = {"four-bar:" + std::to_string(loops)};
    one.implementations = {"null"};
    const double singular = FourBarExact(loops).first_singular_time();
    for (const std::optional<int> steps : {std::optional<int>(), std::optional<int>(60)}) {
      one.steps = steps;
      const BenchPlan plan = plan_bench(one);
      const Stretch& stretch = plan.scenes.front().stretch;
      EXPECT_GE(stretch.start, 0.0);
      EXPECT_LE(stretch.steps, 800);
      EXPECT_EQ(stretch.steps, steps.value_or(stretch.steps));
      EXPECT_NEAR(stretch.start + 0.5 * stretch.steps * 1.25e-3, singular, 1.25e-3);
    }
  }
}

TEST(BenchPlan, KeepsAwayFromAPositionThatCannotBeCrossed) {
  BenchRequest one = request();
  one.scenes = {"four-bar:" + std::to_string(kMostLoopsToCross + 1)};
  one.implementations = {"null"};
  const double singular = FourBarExact(kMostLoopsToCross + 1).first_singular_time();
  const BenchPlan plan = plan_bench(one);
  const Stretch& stretch = plan.scenes.front().stretch;
  EXPECT_GT(stretch.steps, 100);
  EXPECT_GE(stretch.start, 0.0);
  EXPECT_LE(stretch.start, 1.25e-3);
  EXPECT_NEAR(stretch.start + stretch.steps * 1.25e-3, singular - kClearance, 1e-12);
}

TEST(BenchPlan, TakesFewerStepsOfLargeScenes) {
  const auto steps = [](const std::string& scene) {
    return default_steps(load_scene(scene), 1.25e-3);
  };
  EXPECT_EQ(steps("four-bar:199"), 800);
  EXPECT_EQ(steps("four-bar:249"), 640);
  EXPECT_EQ(steps("four-bar:299"), 530) << "320 000 / 600";
  EXPECT_LT(steps("four-bar:499"), 320) << "up to the singular position";
  EXPECT_EQ(steps("four-bar:3999"), 40);
  EXPECT_EQ(most_steps(1), 800);
  EXPECT_EQ(most_steps(401), 800);
  EXPECT_EQ(most_steps(4000), 80);
  EXPECT_EQ(most_steps(1'000'000), 40);
}

TEST(BenchPlan, LongStretchesStartAtZero) {
  BenchRequest one = request();
  one.scenes = {"four-bar:10"};
  one.implementations = {"null/null"};
  one.steps = 16000;
  EXPECT_EQ(plan_bench(one).scenes.front().stretch.start, 0.0);
  one.start = 0.125;
  EXPECT_EQ(plan_bench(one).scenes.front().stretch.start, 0.125);
  ASSERT_EQ(plan_bench(one).cells.size(), 1U);
}

TEST(BenchPlan, GivesTheTangentsFill) {
  BenchRequest filled = request();
  filled.scenes = {"four-bar:10,fill=1", "four-bar:10"};
  filled.implementations = {"null"};
  const BenchPlan plan = plan_bench(filled);
  EXPECT_DOUBLE_EQ(plan.scenes[0].fill_percent, 100.0);
  EXPECT_LT(plan.scenes[1].fill_percent, 30.0);
}

TEST(BenchPlan, RefusesWhatMakesNoSense) {
  const auto refused = [](auto change) {
    BenchRequest bad = request();
    change(bad);
    EXPECT_THROW(plan_bench(bad), UsageError);
  };
  refused([](BenchRequest& r) { r.steps = 0; });
  refused([](BenchRequest& r) { r.steps = -5; });
  refused([](BenchRequest& r) { r.start = -1.0; });
  refused([](BenchRequest& r) { r.start = std::numeric_limits<double>::quiet_NaN(); });
  refused([](BenchRequest& r) { r.start = std::numeric_limits<double>::infinity(); });
  refused([](BenchRequest& r) { r.scenes = {"four-bar:2", "four-bar:2"}; });
  refused([](BenchRequest& r) { r.scenes = {"five-bar:2"}; });
  refused([](BenchRequest& r) { r.seed = -1; });
  refused([](BenchRequest& r) { r.slower_than = 0.5; });
  refused([](BenchRequest& r) { r.slower_than = std::numeric_limits<double>::quiet_NaN(); });
  refused([](BenchRequest& r) { r.patience = 0.0; });
  refused([](BenchRequest& r) { r.patience = std::numeric_limits<double>::infinity(); });
  refused([](BenchRequest& r) { r.implementations = {"null", "no_such"}; });
}

TEST(FilterCells, SelectsAsGoogleBenchmarkDoes) {
  const std::vector<PlannedCell> cells{{"a/b/four-bar:1"}, {"a/b/four-bar:10"}, {"c/d/four-bar:1"}};
  const auto names = [&cells](const std::string& filter) {
    std::string result;
    for (const PlannedCell& cell : filter_cells(cells, filter)) result += cell.name + " ";
    return result;
  };
  EXPECT_EQ(filter_cells(cells, "").size(), 3U);
  EXPECT_EQ(filter_cells(cells, "all").size(), 3U);
  EXPECT_EQ(names("^a/b/four-bar:1$"), "a/b/four-bar:1 ");
  EXPECT_EQ(names("a/b"), "a/b/four-bar:1 a/b/four-bar:10 ");
  EXPECT_EQ(names("-a/b"), "c/d/four-bar:1 ");
  EXPECT_EQ(names("^(a|c)/.*:10?$"), "a/b/four-bar:1 a/b/four-bar:10 c/d/four-bar:1 ");
  EXPECT_THROW(filter_cells(cells, "nothing"), UsageError);
  EXPECT_THROW(filter_cells(cells, "-."), UsageError);
  EXPECT_THROW(filter_cells(cells, "("), UsageError);
}

TEST(Reporters, TurnNumbersThatAreNotFiniteIntoNull) {
  EXPECT_EQ(without_non_finite("{\n  \"a\": NaN,\n  \"b\": -NaN,\n  \"c\": Infinity,\n"
                               "  \"d\": -Infinity\n}"),
            "{\n  \"a\": null,\n  \"b\": null,\n  \"c\": null,\n  \"d\": null\n}");
  const std::string harmless = "{\n  \"error\": \"x: NaN, y: NaN\",\n  \"n\": 1.0e+00\n}\n";
  EXPECT_EQ(without_non_finite(harmless), harmless);
}

TEST(Reporters, DropTheHost) {
  const std::string opening = without_host(
      "{\n  \"context\": {\n    \"host_name\": \"h\",\n    \"executable\": \"/x/mbs\",\n"
      "    \"num_cpus\": 2\n  },\n  \"benchmarks\": [\n");
  EXPECT_EQ(opening,
            "{\n  \"context\": {\n    \"executable\": \"mbs\",\n    \"num_cpus\": 2\n  },\n"
            "  \"benchmarks\": [\n");
}

}  // namespace
}  // namespace mbs
