// What a small rule with made-up numbers recommends.
#include "describe/recommendation.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "describe/describe.hpp"
#include "registry/factory.hpp"
#include "registry/registry.hpp"
#include "scene_file/load_scene.hpp"
#include "support/program.hpp"

namespace mbs {
namespace {

using nlohmann::json;

/// "a/large" and "b/small" are compared; "c/third" is a library too, "d/own" is not. The times are
/// one number for all but b's.
json rule_json() {
  const auto time = [](double us) {
    return json{{"coefficients", {{"1", us}}}, {"low", 0.5}, {"high", 2.0}};
  };
  const auto scene = [](const char* name, int n, double step_us) {
    return json{{"scene", name},
                {"features", {{"n", n}, {"per_column", 3}, {"flops", 9 * n}, {"tangent", 5 * n}}},
                {"fastest", "a/large"},
                {"step_us", step_us}};
  };
  return {{"set", "made-up"},
          {"machine", "a machine"},
          {"commit", "abc"},
          {"candidates", {{"penalty", {"a/large", "b/small"}}, {"saddle-point", {"b/small"}}}},
          {"held",
           {{"families", 3},
            {"scenes", 10},
            {"mean_loss", 0.02},
            {"worst_loss", 0.2},
            {"within", 0.93},
            {"inside", 0.9}}},
          {"times",
           {{"a/large", {{"layer", "library"}, {"penalty", time(8)}}},
            {"b/small",
             {{"layer", "library"},
              {"penalty",
               {{"coefficients", {{"1", 1.75}, {"n*n", 0.0625}}}, {"low", 0.75}, {"high", 1.5}}},
              {"saddle-point", time(30)}}},
            {"c/third", {{"layer", "library"}, {"penalty", time(6)}}},
            {"d/own", {{"layer", "own"}, {"penalty", time(5)}, {"saddle-point", nullptr}}}}},
          {"scenes", json::array({scene("small", 6, 7.5), scene("middle", 50, 70.0)})}};
}

std::string anything(const std::string& /*variant*/, Scheme /*scheme*/) { return ""; }

json described(const std::string& scene, const StepSettings& settings = {}) {
  return describe_json(load_scene(scene), settings);
}

json recommended(const json& description, const WhyNot& why_not = anything) {
  json result = description;
  result.update(recommendation_json(parse_rule(rule_json().dump()), description, why_not));
  return result;
}

std::vector<std::string> names(const json& d) {
  std::vector<std::string> result;
  for (const json& one : d["recommendation"]) result.push_back(one["implementation"]);
  return result;
}

using Names = std::vector<std::string>;

TEST(Recommendation, FastestCandidateFirstThenByTimeThenOwnCode) {
  const json d = recommended(described("four-bar:2"));  // n = 6
  EXPECT_EQ(names(d), (Names{"b/small", "c/third", "a/large", "d/own"}));
  EXPECT_EQ(d["recommendation"][0], json({{"layer", "library"},
                                          {"implementation", "b/small"},
                                          {"scheme", "penalty"},
                                          {"step_us", 4.0},
                                          {"low_us", 2.25},
                                          {"high_us", 9.0}}));
  EXPECT_EQ(d["recommendation"][3]["layer"], "own");
  EXPECT_EQ(d["rule"]["candidates"],
            json::array({{{"implementation", "a/large"}, {"step_us", 8.0}, {"refused", nullptr}},
                         {{"implementation", "b/small"}, {"step_us", 4.0}, {"refused", nullptr}}}));
  EXPECT_EQ(d["rule"]["set"], "made-up");
  EXPECT_EQ(d["rule"]["held"]["within"], 0.93);
  EXPECT_TRUE(d["no_recommendation"].is_null());
}

TEST(Recommendation, NearestSceneAndWhatIsOutside) {
  const json d = recommended(described("four-bar:2"));  // L has 17 non-zeros, 55 operations
  EXPECT_EQ(d["nearest"]["scene"], "small");
  EXPECT_EQ(d["nearest"]["fastest"], "a/large");
  EXPECT_EQ(d["nearest"]["step_us"], 7.5);
  EXPECT_NEAR(d["nearest"]["distance"],
              std::hypot(std::log(17.0 / 18.0), std::log(55.0 / 54.0), std::log(28.0 / 30.0)),
              1e-12);
  EXPECT_EQ(d["rule"]["outside"], json::array({"per_column", "tangent"}));
}

TEST(Recommendation, ARangeIsNarrowerAmongWhatWasMeasured) {
  json description = described("four-bar:2");
  description["features"].update({{"per_column", 3}, {"flops", 9 * 6}, {"tangent", 5 * 6}});
  const json d = recommended(description);
  EXPECT_EQ(d["rule"]["outside"], json::array());
  EXPECT_EQ(d["recommendation"][0]["low_us"], 3.0);
  EXPECT_EQ(d["recommendation"][0]["high_us"], 6.0);
}

TEST(Recommendation, Text) {
  const std::string text = recommendation_text(recommended(described("four-bar:2")));
  EXPECT_EQ(text,
            "take this             b/small, penalty form: 4 us a step (2.25 to 9), predicted from "
            "times on a "
            "machine\n"
            "  why                 the least of those compared: a/large 8 us, "
            "b/small 4 us; penalty form, as the automatic penalty factor is stable at "
            "step 0.00125 s\n"
            "  how sure            3 families (10 scenes) left out in turn: 2 % slower than their "
            "fastest in the mean, 20 % at worst; 93 % of the times right to a factor of 1.5, 90 % "
            "inside their range; extrapolated, as this scene is outside of all measured ones in "
            "non-zeros a column of L, non-zeros of the tangent\n"
            "  nearest measured    small (distance 0.091): a/large, 7.5 us\n"
            "  own code            d/own, penalty form: 5 us a step (1.25 to 20)\n");
}

TEST(Recommendation, TheOtherCandidateWhereItIsFaster) {
  const json d = recommended(described("four-bar:60"));  // n = 122
  EXPECT_EQ(names(d), (Names{"a/large", "c/third", "b/small", "d/own"}));
  EXPECT_EQ(d["nearest"]["scene"], "middle");
}

TEST(Recommendation, ACandidateThatDoesNotServeTheSceneGivesWayToTheOthers) {
  const auto without = [](const Names& refused) {
    return recommended(described("four-bar:2"), [refused](const std::string& name, Scheme) {
      const bool is_one = std::ranges::find(refused, name) != refused.end();
      return std::string(is_one ? "it does not serve springs" : "");
    });
  };
  const json d = without({"b/small"});
  EXPECT_EQ(names(d), (Names{"a/large", "c/third", "d/own"}));
  EXPECT_EQ(d["rule"]["candidates"][1]["refused"], "it does not serve springs");
  EXPECT_TRUE(d["rule"]["candidates"][1]["step_us"].is_null());
  EXPECT_NE(recommendation_text(d).find("a/large 8 us, b/small: it does not serve springs; "),
            std::string::npos);
  EXPECT_EQ(names(without({"a/large", "b/small"})), (Names{"c/third", "d/own"}));
}

TEST(Recommendation, WhatWasTooMuchToCountIsNoCandidate) {
  json d = described("four-bar:2");
  d["features"]["n"] = nullptr;
  EXPECT_EQ(names(recommended(d)), (Names{"a/large", "c/third", "d/own"}));
}

TEST(Recommendation, SaddlePointFormOnlyWhereItWasMeasured) {
  json described_one = described("four-bar:40");
  described_one["scheme"] = {{"take", "saddle-point"},
                             {"reason", "saddle-point form, as no penalty factor suits"}};
  const json d = recommended(described_one);
  EXPECT_EQ(names(d), (Names{"b/small"}));
  EXPECT_EQ(d["recommendation"][0]["scheme"], "saddle-point");
  EXPECT_EQ(d["recommendation"][0]["high_us"], 120.0);
  EXPECT_EQ(d["rule"]["candidates"].size(), 1U);
  EXPECT_NE(recommendation_text(d).find("saddle-point form, as no penalty factor"),
            std::string::npos);
}

TEST(Recommendation, NothingIsRecommendedWithoutARule) {
  const json d = described("four-bar:2");
  json result = recommendation_json(parse_rule("{}"), d, anything);
  EXPECT_EQ(result["recommendation"], json::array());
  EXPECT_TRUE(result["rule"].is_null());
  EXPECT_TRUE(result["nearest"].is_null());
  EXPECT_EQ(recommendation_text(result),
            "take this             no rule has been measured for this build\n");
  result = recommended(described("four-bar:2", {.precision = Precision::single_precision}));
  EXPECT_EQ(result["no_recommendation"], "steps were measured in double precision only");
  result = recommended(d, [](const std::string&, Scheme) { return "it is not in this build"; });
  EXPECT_EQ(result["recommendation"], json::array());
  EXPECT_EQ(result["no_recommendation"], "nothing that was measured can run this");
}

/// `change` turns the rule into one that is refused for a reason with `part` in it.
template <class Change>
void expect_rule_refused(const char* part, Change change) {
  json rule = rule_json();
  change(rule);
  try {
    static_cast<void>(parse_rule(rule.dump()));
    ADD_FAILURE() << "not refused: " << part;
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
  }
}

TEST(Recommendation, RefusesWhatIsNoRule) {
  EXPECT_THROW(static_cast<void>(parse_rule("")), std::runtime_error);
  EXPECT_THROW(static_cast<void>(parse_rule("[]")), std::runtime_error);
  expect_rule_refused("key 'candidates' not found", [](json& rule) { rule.erase("candidates"); });
  expect_rule_refused("the candidate d/own is no library with times in the penalty form",
                      [](json& rule) { rule["candidates"]["penalty"] = {"d/own"}; });
  expect_rule_refused("the candidate a/large is no library with times in the saddle-point form",
                      [](json& rule) { rule["candidates"]["saddle-point"] = {"a/large"}; });
  expect_rule_refused("there are 7 candidates, allowed are 1 to 6",
                      [](json& rule) { rule["candidates"]["penalty"] = Names(6, "a/large"); });
  expect_rule_refused("the layer is 'other'",
                      [](json& rule) { rule["times"]["a/large"]["layer"] = "other"; });
  expect_rule_refused("n*m is -1, allowed", [](json& rule) {
    rule["times"]["a/large"]["penalty"]["coefficients"]["n*m"] = -1;
  });
  expect_rule_refused("'colour' is no feature", [](json& rule) {
    rule["times"]["a/large"]["penalty"]["coefficients"]["n*colour"] = 1;
  });
  expect_rule_refused("low is above high",
                      [](json& rule) { rule["times"]["a/large"]["penalty"]["low"] = 3; });
  expect_rule_refused("a/large has no times",
                      [](json& rule) { rule["times"]["a/large"].erase("penalty"); });
  expect_rule_refused("must be string", [](json& rule) { rule["machine"] = 3; });
  expect_rule_refused("there are no scenes", [](json& rule) { rule["scenes"] = json::array(); });
  expect_rule_refused("feature flops is missing or 0",
                      [](json& rule) { rule["scenes"][0]["features"].erase("flops"); });
}

TEST(Recommendation, TheRuleOfThisBuildIsOneOrNone) {
  EXPECT_NO_THROW(static_cast<void>(parse_rule(kRuleText)));
}

TEST(Recommendation, TheProgramPrintsIt) {
  const auto text = test::run_mbs("describe four-bar:2");
  EXPECT_EQ(text.status, 0) << text.errors;
  EXPECT_NE(text.output.find("\ntake this             "), std::string::npos) << text.output;
  const auto found = test::run_mbs("describe four-bar:2 --json");
  ASSERT_EQ(found.status, 0) << found.errors;
  const json d = json::parse(found.output);
  for (const char* key : {"elimination", "features", "nearest", "rule", "no_recommendation"}) {
    EXPECT_TRUE(d.contains(key)) << key;
  }
  EXPECT_EQ(d["recommendation"].empty(), d["no_recommendation"].is_string());
}

TEST(Recommendation, NamesNobodyWhoRefusesTheScene) {
  for (const char* name :
       {"ladder:4", "truss:1", "tree:7", "grid:2x2", "vehicle:2", "four-bar:3"}) {
    const auto found = test::run_mbs(fmt::format("describe {} --json", name));
    ASSERT_EQ(found.status, 0) << found.errors;
    const Scene scene = load_scene(name);
    const json description = json::parse(found.output);
    EXPECT_FALSE(description["recommendation"].empty()) << name;
    for (const json& one : description["recommendation"]) {
      StepSettings settings{.step = 1e-3, .penalty = 1e9, .tolerance = 1e-9};
      if (one["scheme"] == "saddle-point") settings.scheme = Scheme::saddle_point;
      const std::string variant = one["implementation"];
      EXPECT_NO_THROW(
          create_simulation(*select_variants({variant})[0].variant, scene.model, settings))
          << variant << ", " << name;
    }
  }
}

}  // namespace
}  // namespace mbs
