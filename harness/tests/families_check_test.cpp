// Every family through the gate, by every implementation that serves its terms.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "reference/reference_simulation.hpp"
#include "registry/factory.hpp"
#include "registry/registry.hpp"
#include "run/initial_state.hpp"
#include "scene/families/families.hpp"
#include "scene_file/load_scene.hpp"
#include "support/program.hpp"

namespace mbs {
namespace {

/// A small size of each family, with the options that change a scene's terms.
constexpr const char* kSmall =
    "chain:3 chain:3,dimension=3 loop:5 tree:6 ladder:3 grid:2x2 cloth:2x3 truss:1,bays=2 "
    "scissors:2 bodies:3 bodies:2,dimension=3 vehicle:2 robot:6 star:4 clusters:2,size=4 "
    "flexible:2,nodes=4";

/// The check passes if all that serve the terms agree; csc_klu and eigen_dense serve all.
void expect_agreement(const std::string& scenes, const std::string& scheme) {
  const std::string file = test::temporary_path("verdicts.json");
  const auto run =
      test::run_mbs("check " + scenes + " --scheme " + scheme + " --json '" + file + "'");
  EXPECT_EQ(run.status, 0) << run.output << run.errors;
  const nlohmann::json verdicts = nlohmann::json::parse(test::file_text(file));
  std::filesystem::remove(file);
  for (const nlohmann::json& row : verdicts.at("rows")) {
    const std::string who = row.at("implementation");
    if (!who.starts_with("csc_klu/") && !who.starts_with("eigen_dense/")) continue;
    EXPECT_EQ(row.at("verdict"), "agrees") << row.at("scene") << who << row.at("reason");
  }
}

TEST(FamiliesCheck, NamesEveryFamily) {
  for (const SceneFamily& family : scene_families()) {
    EXPECT_NE(std::string(kSmall).find(std::string(family.name) + ":"), std::string::npos)
        << family.name;
  }
}

TEST(FamiliesCheck, PenaltyFormAgrees) {
  if (all_variants().empty()) GTEST_SKIP() << "no implementation is available";
  expect_agreement(kSmall, "penalty");
}

TEST(FamiliesCheck, SaddlePointFormAgrees) {
  if (all_variants().empty()) GTEST_SKIP() << "no implementation is available";
  expect_agreement(kSmall, "saddle-point");
}

/// Long and with one degree of freedom: rounding of alpha Phi_q^T Phi_q in T would change its
/// speed, if the projections solved for all of it.
TEST(FamiliesCheck, LongScissorsKeepTheirSpeedInThePenaltyForm) {
  if (all_variants().empty()) GTEST_SKIP() << "no implementation is available";
  expect_agreement("scissors:50", "penalty");
}

/// What moves with rods of a billionth of the mass beside it: a projection whose Phi_q is not the
/// one in T throws them off, by as much as alpha is large.
TEST(FamiliesCheck, LightPartsMoveAsInTheSaddlePointForm) {
  const Scene scene = scene_of(nlohmann::json::parse(R"({"gravity": [0, -9.81], "points": [
      {"name": "A", "position": [0, 0], "fixed": true}, {"name": "B", "position": [1, 0]},
      {"name": "C", "position": [1.5, 0.5]}, {"name": "D", "position": [2.0, 0.4]}],
    "rods": [{"between": ["A", "B"], "mass": 1}, {"between": ["B", "C"], "mass": 1e-9},
             {"between": ["C", "D"], "mass": 1e-9}]})"),
                               "light");
  const auto final_position = [&](Simulation& simulation) {
    simulation.set_state(initial_state(scene.model));
    for (int step = 0; step < 400; ++step) (void)simulation.step();
    State state;
    simulation.get_state(state);
    return state.q;
  };
  StepSettings settings{.step = 1e-3, .penalty = 1e8, .tolerance = 1e-10, .max_passes = 20};
  settings.scheme = Scheme::saddle_point;
  ReferenceSimulation reference(scene.model, settings);
  const auto expected = final_position(reference);
  settings.scheme = Scheme::penalty;
  for (const NamedVariant& each : all_variants()) {
    if (!why_not_offered(each.name, scene.model, settings).empty()) continue;
    const auto q = final_position(*create_simulation(*each.variant, scene.model, settings));
    for (std::size_t i = 0; i < q.size(); ++i) EXPECT_NEAR(q[i], expected[i], 1e-4) << each.name;
  }
}

}  // namespace
}  // namespace mbs
