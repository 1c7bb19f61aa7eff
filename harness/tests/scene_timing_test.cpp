// All contenders of a scene against each other: samples, failures, slow ones, and the table.
#include "bench/scene_timing.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <deque>

#include "bench/bench_rows.hpp"
#include "bench/null_variant.hpp"
#include "bench/paired_ratio.hpp"
#include "bench/scene_table.hpp"
#include "scene_file/load_scene.hpp"
#include "support/scripted_simulation.hpp"

namespace mbs {
namespace {

using test::create_scripted;
using test::Scripted;
using Script = Scripted::Script;

/// Ten steps that are so short that standing still is no divergence.
class SceneTimingTest : public ::testing::Test {
 protected:
  SceneTimingTest() {
    Scripted::steps = Scripted::starts = 0;
    wishes_.slice = 1e-9;  // turns of a step
    wishes_.samples = 4;
  }

  static PlannedScene plan() {
    const StepSettings settings{1e-7, 1e8, 1e-9, 20};
    Scene scene = load_scene("four-bar:2");
    Stretch stretch = make_stretch(scene, settings.step, 10, 0.0);
    return {std::move(scene), settings, std::move(stretch), 50.0};
  }

  void add(const std::string& name, decltype(Variant::create) create) {
    variants_.push_back({name, "", create});
    cells_.push_back({"scripted/" + name + "/four-bar:2", &planned_, &variants_.back(), false});
  }
  void add_control() {
    cells_.push_back({"null/null/four-bar:2", &planned_, &null_variant(), true});
  }
  SceneResult time() { return time_scene(cells_, wishes_, {}); }

  const PlannedScene planned_ = plan();
  TimingWishes wishes_;
  std::deque<Variant> variants_;
  std::vector<PlannedCell> cells_;
};

TEST_F(SceneTimingTest, EverySampleIsTheWholeStretchOfEachContender) {
  add("a", create_scripted<Script::still>);
  add("b", create_scripted<Script::still>);
  const SceneResult result = time();
  EXPECT_EQ(result.turns.count(), 10);
  EXPECT_EQ(Scripted::steps, 2 * (10 + 4 * 10)) << "a stretch of warm-up and four samples";
  EXPECT_EQ(Scripted::starts, 2 * (5 + 1 + 4)) << "set-ups, warm-up, samples";
  EXPECT_EQ(Scripted::alive, 0);
  for (const ContenderResult& contender : result.contenders) {
    EXPECT_TRUE(contender.timed()) << contender.failure;
    ASSERT_EQ(contender.samples.size(), 4U);
    EXPECT_EQ(contender.figures.passes, 20);
    for (const Sample& sample : contender.samples) {
      EXPECT_EQ(sample.stretches, 1);
      EXPECT_GT(sample.spent.seconds, 0.0);
    }
  }
}

TEST_F(SceneTimingTest, RepeatsShortStretches) {
  add("fast", create_scripted<Script::still>);
  add("slow", create_scripted<Script::slow>);
  wishes_.slice = 0.02;
  const SceneResult result = time();
  EXPECT_EQ(result.turns.count(), 1);
  EXPECT_GT(result.contenders[0].samples[0].stretches, 1000);
  EXPECT_LE(result.contenders[1].samples[0].stretches, 100) << "4, unless interrupted";
  for (const Sample& sample : result.contenders[1].samples) {
    EXPECT_GE(sample.spent.seconds, 10 * 500e-6 * static_cast<double>(sample.stretches));
  }
  EXPECT_LT(median(result.contenders[0].step_times()), 5.0);
  EXPECT_GT(median(result.contenders[1].step_times()), 50.0);
}

TEST_F(SceneTimingTest, ChoosesTheNumberOfSamples) {
  add("a", create_scripted<Script::slow>);
  wishes_.samples = 0;
  wishes_.slice = 0.5;  // 2 s have room for four
  const SceneResult result = time();
  EXPECT_GE(result.samples, kLeastSamples);
  EXPECT_LE(result.samples, 4);
  EXPECT_EQ(result.contenders[0].samples.size(), static_cast<std::size_t>(result.samples));
}

TEST_F(SceneTimingTest, OneThatFailsLeavesTheOthersAlone) {
  add("good", create_scripted<Script::still>);
  add("refuses", create_scripted<Script::refuses>);
  add("later", create_scripted<Script::refuses_later>);
  add("number", create_scripted<Script::throws_number>);
  add("none", [](const Model&, const StepSettings&) -> std::unique_ptr<Simulation> {
    throw Unsupported("only three dimensions");
  });
  const SceneResult result = time();
  EXPECT_EQ(result.contenders[0].samples.size(), 4U);
  for (std::size_t i = 1; i < 5; ++i) EXPECT_TRUE(result.contenders[i].samples.empty());
  const std::string refused = "factorization-failed: the tangent of step 4 of 10 was refused";
  EXPECT_EQ(result.contenders[1].failure, refused);
  EXPECT_EQ(result.contenders[2].failure, refused);
  EXPECT_EQ(result.contenders[3].failure, "error: it threw what is no std::exception");
  EXPECT_EQ(result.contenders[4].failure, "unsupported: only three dimensions");
  EXPECT_TRUE(result.contenders[3].failed());
  EXPECT_FALSE(result.contenders[4].failed()) << "an answer";
  EXPECT_EQ(Scripted::alive, 0);
}

TEST_F(SceneTimingTest, LeavesOutTheSlow) {
  add_control();  // does nothing: nobody is compared with it
  add("slow", create_scripted<Script::slow>);
  add("fast", create_scripted<Script::still>);
  wishes_.slower_than = 50;
  const SceneResult result = time();
  EXPECT_TRUE(result.contenders[0].timed());
  EXPECT_TRUE(result.contenders[2].timed()) << result.contenders[2].failure;
  const ContenderResult& slow = result.contenders[1];
  EXPECT_TRUE(slow.failure.starts_with("slower: at least 50 times the fastest (first look: "))
      << slow.failure;
  EXPECT_FALSE(slow.failed());
  ASSERT_TRUE(slow.look_seconds.has_value());
  EXPECT_GE(*slow.look_seconds, 5e-5);
  const auto rows = rows_of(result, slow, 1);
  ASSERT_EQ(rows.size(), 1U);
  EXPECT_TRUE(rows[0].error_occurred);
  EXPECT_NEAR(rows[0].counters.at("step_us").value, 1e6 * *slow.look_seconds, 1e-9);
}

TEST_F(SceneTimingTest, LosesPatience) {
  add("slow", create_scripted<Script::slow>);
  add("fast", create_scripted<Script::still>);
  wishes_.patience = 0.002;
  const SceneResult result = time();
  const std::string& failure = result.contenders[0].failure;
  EXPECT_TRUE(failure.starts_with("slower: did not finish the stretch of 10 steps within 0.002 s"))
      << failure;
  EXPECT_LE(Scripted::steps, 6 + 10 + 40);
  EXPECT_TRUE(result.contenders[1].timed());
}

TEST_F(SceneTimingTest, LeavesOutTheSlowOfEachLayer) {
  add("library", create_scripted<Script::still>);
  add("slow_library", create_scripted<Script::slow>);
  add("own", create_scripted<Script::slow>);
  cells_[2].own_code = true;
  wishes_.slower_than = 50;
  wishes_.by_layer = true;
  const SceneResult result = time();
  EXPECT_TRUE(result.contenders[0].timed()) << result.contenders[0].failure;
  EXPECT_TRUE(result.contenders[1].failure.starts_with(
      "slower: at least 50 times the fastest of its layer (first look: "))
      << result.contenders[1].failure;
  EXPECT_TRUE(result.contenders[2].timed()) << "slower than a library only";
}

TEST_F(SceneTimingTest, NarrowsWhatItLeavesOutToFitItsBudget) {
  add("fast", create_scripted<Script::still>);
  add("slow", create_scripted<Script::slow>);
  wishes_.slower_than = 1e9;
  wishes_.by_layer = true;
  wishes_.budget = 100.0;
  EXPECT_TRUE(time().contenders[1].timed());
  wishes_.budget = 1e-6;
  const SceneResult result = time();
  EXPECT_TRUE(result.contenders[0].timed()) << "the fastest of its layer stays";
  EXPECT_TRUE(result.contenders[1].failure.starts_with(
      "slower: at least 5 times the fastest of its layer (first look: "))
      << result.contenders[1].failure;
}

TEST_F(SceneTimingTest, DoesNotSetUpWhatItsOperationsRuleOut) {
  const StepSettings settings{1e-7, 1e8, 1e-9, 20};
  Scene scene = load_scene("four-bar:1000");
  Stretch stretch = make_stretch(scene, settings.step, 10, 0.0);
  const PlannedScene big{std::move(scene), settings, std::move(stretch), 1.0};
  add("dense", create_scripted<Script::slow>);
  add("sparse", create_scripted<Script::slow>);
  variants_[0].dense = true;
  for (PlannedCell& cell : cells_) {
    cell.scene = &big;
    cell.name = "scripted/" + cell.variant->name + "/four-bar:1000";
  }
  wishes_.slower_than = 10;
  EXPECT_TRUE(time().contenders[0].timed()) << "only a summary leaves it out";
  wishes_.by_layer = true;
  Scripted::starts = 0;
  std::vector<std::string> said;
  const SceneResult result =
      time_scene(cells_, wishes_, [&said](const std::string& what) { said.push_back(what); });
  EXPECT_EQ(result.contenders[0].failure,
            "slower: at least 10 times the fastest of its layer (by its number of operations)");
  EXPECT_TRUE(result.contenders[1].timed()) << result.contenders[1].failure;
  EXPECT_EQ(Scripted::starts, 5 + 1 + 4) << "of the sparse one alone";
  EXPECT_EQ(said.front(), "four-bar:1000: set-up 1 of 2, scripted/sparse") << "the likely fast";
}

TEST_F(SceneTimingTest, RowsAreSamples) {
  add("a", create_scripted<Script::still>);
  const SceneResult result = time();
  const auto rows = rows_of(result, result.contenders[0], 3);
  ASSERT_EQ(rows.size(), 4U);
  for (std::size_t j = 0; j < rows.size(); ++j) {
    EXPECT_EQ(rows[j].benchmark_name(), "scripted/a/four-bar:2");
    EXPECT_EQ(rows[j].repetition_index, static_cast<long>(j));
    EXPECT_EQ(rows[j].repetitions, 4);
    EXPECT_EQ(rows[j].iterations, 1);
    EXPECT_NEAR(rows[j].GetAdjustedRealTime(), 10 * rows[j].counters.at("step_us").value, 1e-9);
  }
}

TEST_F(SceneTimingTest, TheTableHasTheFastestFirstAndFailuresLast) {
  add("refuses", create_scripted<Script::refuses>);
  add("slow", create_scripted<Script::slow>);
  add("phases", create_scripted<Script::phases>);
  add("fast", create_scripted<Script::still>);
  add_control();
  wishes_.samples = 7;
  wishes_.phases = true;
  const std::string table = scene_table(time());
  std::vector<std::size_t> places;
  for (const char* line :
       {"four-bar:2: 6 variables", "7 samples of each, in 10 turns", "\nscripted/fast",
        "\nscripted/phases", "\nscripted/slow", "\nscripted/refuses", "\nshares of the time",
        "\nscripted/fast", "\nscripted/phases"}) {
    places.push_back(table.find(line, places.empty() ? 0 : places.back() + 1));
    ASSERT_NE(places.back(), std::string::npos) << line << " in\n" << table;
  }
  EXPECT_NE(table.find("factorization-failed: the tangent of step 4"), std::string::npos) << table;
  EXPECT_NE(table.find("null/null"), std::string::npos);
  EXPECT_EQ(table.find("nan"), std::string::npos) << table;
}

}  // namespace
}  // namespace mbs
