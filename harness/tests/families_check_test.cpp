// Every family through the gate, by every implementation that serves its terms.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "registry/registry.hpp"
#include "scene/families/families.hpp"
#include "support/program.hpp"

namespace mbs {
namespace {

/// A small size of each family, with the options that change a scene's terms.
constexpr const char* kSmall =
    "chain:3 chain:3,dimension=3 loop:5 tree:6 ladder:3 grid:2x2 truss:1,bays=2 scissors:2 "
    "bodies:3 bodies:2,dimension=3 vehicle:2 robot:6 star:4 clusters:2,size=4 flexible:2,nodes=4";

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

}  // namespace
}  // namespace mbs
