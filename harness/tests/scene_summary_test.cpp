// The summary of a scene, from times that a test makes up.
#include "bench/scene_summary.hpp"

#include <gtest/gtest.h>

#include <deque>
#include <sstream>

#include "scene_file/load_scene.hpp"

namespace mbs {
namespace {

class SceneSummaryTest : public ::testing::Test {
 protected:
  SceneSummaryTest() {
    result_.scene = &planned_;
    result_.samples = 8;
  }

  static PlannedScene plan() {
    const StepSettings settings{1e-3, 1e8, 1e-9, 20};
    Scene scene = load_scene("four-bar:2");
    Stretch stretch = make_stretch(scene, settings.step, 10, 0.0);
    return {std::move(scene), settings, std::move(stretch), 50.0};
  }

  ContenderResult& add(const std::string& name, bool own_code) {
    cells_.push_back({name + "/four-bar:2", &planned_, nullptr, false, own_code});
    ContenderResult& contender = result_.contenders.emplace_back();
    contender.cell = &cells_.back();
    return contender;
  }
  /// @param us a step
  void add_timed(const std::string& name, double us, bool own_code = false) {
    ContenderResult& contender = add(name, own_code);
    const double seconds = 1e-6 * us * planned_.stretch.steps;
    contender.samples.assign(8, {{clock_ * seconds, seconds}, 1});
    contender.figures.passes = 20;
  }
  void add_failed(const std::string& name, const std::string& failure) {
    add(name, false).failure = failure;
  }

  const PlannedScene planned_ = plan();
  double clock_ = 1.0;  ///< as long as the processor's time
  std::deque<PlannedCell> cells_;
  SceneResult result_;
};

TEST_F(SceneSummaryTest, NamesTheFastestOfEitherLayerAndWhoIsAsFast) {
  add_timed("library/third", 2.4);
  add_timed("library/second", 2.06);
  add_timed("library/first", 2.0);
  add_timed("own/first", 1.0, true);
  add_timed("own/second", 1.04, true);
  EXPECT_EQ(scene_summary(result_, 1.0),
            "four-bar:2: 6 variables, 5 constraints, tangent filled to 50 %\n"
            "10 steps of 1 ms from t = 0 s, 8 samples of each\n"
            "                           µs a step  to the fastest         passes\n"
            "own/first              own         1  1                       2.000\n"
            "own/second             own      1.04  1.040 (1.040..1.040)    2.000  as fast\n"
            "library/first                      2  2.000 (2.000..2.000)    2.000\n"
            "library/second                  2.06  2.060 (2.060..2.060)    2.000\n"
            "library/third                    2.4  2.400 (2.400..2.400)    2.000\n"
            "\n"
            "fastest library:  library/first, 2 µs a step; as fast: library/second\n"
            "fastest own code: own/first, 1 µs a step; as fast: own/second\n"
            "\n");
}

TEST_F(SceneSummaryTest, FewSamplesShowNobodyAsFast) {
  add_timed("library/first", 2.0);
  add_timed("library/second", 2.0);
  for (ContenderResult& contender : result_.contenders) contender.samples.resize(5);
  EXPECT_EQ(scene_summary(result_, 1.0).find("as fast"), std::string::npos);
}

TEST_F(SceneSummaryTest, TellsEqualReasonsOnceWithin80Columns) {
  add_timed("library/first", 2.0);
  for (const char* name : {"a", "b", "c", "d", "e", "f"}) {
    add_failed(std::string("a_library_of_some_length/") + name,
               std::string("slower: at least 10 times the fastest of its layer (first look: ") +
                   name + " µs a step)");
  }
  add_failed("chains/one", "unsupported: only chains (mbs list tells who does)");
  add_failed("chains/two", "unsupported: only chains (mbs list tells who does)");
  add_failed("bad/one", "diverged: the state is not finite");
  const std::string text = scene_summary(result_, 1.0);
  EXPECT_NE(
      text.find("left out:\n"
                "  slower: at least 10 times the fastest of its layer:\n"
                "    a_library_of_some_length/a, a_library_of_some_length/b,\n"
                "    a_library_of_some_length/c, a_library_of_some_length/d,\n"
                "    a_library_of_some_length/e, a_library_of_some_length/f\n"
                "  unsupported: only chains (mbs list tells who does): chains/one, chains/two\n"
                "  diverged: the state is not finite: bad/one\n"),
      std::string::npos)
      << text;
  std::istringstream lines(text + summary_footer());
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 81U) << line;
}

TEST_F(SceneSummaryTest, SaysWhenTheMachineWasBusy) {
  const auto notes = [this](double load) {
    return scene_summary(result_, load).find("The machine was busy: ") != std::string::npos;
  };
  add_timed("library/first", 2.0);
  EXPECT_FALSE(notes(1.0));
  EXPECT_FALSE(notes(-1.0)) << "not known";
  EXPECT_TRUE(notes(1e4));
  clock_ = 1.5;
  add_timed("library/second", 2.0);
  EXPECT_TRUE(notes(-1.0));
}

TEST_F(SceneSummaryTest, NobodyTimedIsNoTable) {
  add_failed("bad/one", "diverged: the state is not finite");
  result_.samples = 0;
  const std::string text = scene_summary(result_, 1.0);
  EXPECT_EQ(text.find("to the fastest"), std::string::npos) << text;
  EXPECT_EQ(text.find("fastest library"), std::string::npos) << text;
  EXPECT_NE(text.find("diverged"), std::string::npos) << text;
}

TEST(Filled, BreaksAtBlanksOnly) {
  EXPECT_EQ(filled("short"), "short\n");
  EXPECT_EQ(filled("  " + std::string(78, 'x')), "  " + std::string(78, 'x') + "\n");
  EXPECT_EQ(filled(std::string(79, 'x') + " yy"), std::string(79, 'x') + "\n    yy\n");
  EXPECT_EQ(filled(std::string(100, 'x')), std::string(100, 'x') + "\n");
}

}  // namespace
}  // namespace mbs
