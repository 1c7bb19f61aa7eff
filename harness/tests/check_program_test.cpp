// `mbs check` from the outside: verdicts of the real implementations, JSON, errors.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "check/gate.hpp"
#include "registry/registry.hpp"
#include "run/settings.hpp"
#include "scene_file/load_scene.hpp"
#include "support/folder.hpp"
#include "support/program.hpp"

namespace mbs {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

TEST(CheckProgram, WhatWasTriedAgreesAndBelongsToAVariant) {
  if (tried_variants().empty()) GTEST_SKIP() << "no variant was tried for another";
  std::string names;
  for (const NamedVariant& one : tried_variants()) {
    names += " --implementation " + one.name;
    const std::string base = one.entry->folder + "/" + one.variant->tried_for;
    EXPECT_TRUE(std::ranges::any_of(all_variants(), [&](const NamedVariant& other) {
      return other.name == base;
    })) << base;
  }
  const std::string scenes =
      MBS_SANITIZE ? "four-bar:3 grid:2x2" : "four-bar:10 four-bar:20,fill=0.5 grid:4x4";
  const auto run = test::run_mbs("check " + scenes + " --time-limit 2000" + names);
  EXPECT_EQ(run.status, 0) << run.output << run.errors;
}

TEST(CheckProgram, WhatAStiffDamperLeavesIsNoDisagreement) {
  if (all_variants().empty()) GTEST_SKIP() << "no implementation is available";
  const auto run = test::run_mbs("check '" MBS_ROOT "/harness/scenes/problems/a05_governor.json' --time-limit 2000 "
      "--scheme saddle-point --implementation csc_ldl/uplooking,eigen_dense/llt");
  EXPECT_EQ(run.status, 0) << run.output << run.errors;
}

TEST(CheckProgram, ComparesAsManyStepsAsAskedFor) {
  const auto run = test::run_program(
      MBS_CONTROLS, "check four-bar:2 --steps 17 --implementation control/reference");
  EXPECT_EQ(run.status, 0) << run.errors;
  EXPECT_NE(run.output.find("m; 17 of 17 steps"), std::string::npos) << run.output;
}

TEST(CheckProgram, AFileMayHaveAnyName) {
  const test::Folder folder;
  const std::string scene = folder.file("\xff.json"), verdicts = folder.file("verdicts");
  fs::copy_file(MBS_ROOT "/harness/scenes/pendulum.json", scene);
  const auto run = test::run_program(
      MBS_CONTROLS, "check '" + scene + "' --implementation control/reference --json '" + verdicts + "'");
  EXPECT_EQ(run.status, 0) << run.errors;
  const std::string command = json::parse(test::file_text(verdicts)).at("context").at("command");
  EXPECT_NE(command.find("\\xFF.json"), std::string::npos) << command;
}

TEST(CheckProgram, AllImplementationsAgree) {
  if (all_variants().empty()) GTEST_SKIP() << "no implementation is available";
  const std::string file = test::temporary_path("verdicts.json");
  const std::string pendulum = MBS_ROOT "/harness/scenes/double_pendulum.json";
  // Small where the build is slow (sanitizers), with time enough that the gate leaves nothing out.
  const std::string scenes =
      MBS_SANITIZE ? "four-bar:3,fill=0.9" : "four-bar:1 four-bar:10 four-bar:10,fill=0.6 '" + pendulum + "'";
  const auto run = test::run_mbs("check " + scenes + " --time-limit 2000 --json '" + file + "'");
  EXPECT_EQ(run.status, 0) << run.output;
  EXPECT_EQ(run.errors, "");
  const json verdicts = json::parse(test::file_text(file));
  fs::remove(file);
  for (const char* key :
       {"mbs_version", "commit", "dirty", "compiler", "flags", "build_type", "blas_loaded",
        "libraries", "cpu_model", "machine", "kernel", "threads_environment", "command"}) {
    EXPECT_TRUE(verdicts.at("context").at(key).is_string()) << key;
  }
  EXPECT_EQ(verdicts.at("rows").size(), (MBS_SANITIZE ? 1 : 4) * all_variants().size());
  std::set<std::string> agreed, left;  // scene and folder
  for (const json& row : verdicts.at("rows")) {
    const std::string name =
        row.at("scene").get<std::string>() + " " + row.at("implementation").get<std::string>();
    SCOPED_TRACE(name);
    const bool refused = row.at("verdict") == "unsupported";
    (refused ? left : agreed).insert(name.substr(0, name.rfind('/')));
    if (refused) continue;
    EXPECT_EQ(row.at("verdict"), "agrees");
    EXPECT_EQ(row.at("reason"), "");
    std::set<std::string> names;
    for (const json& check : row.at("checks")) {
      names.insert(check.at("name").get<std::string>());
      EXPECT_EQ(check.at("passed"), true) << check;
      EXPECT_LE(check.at("value"), check.at("tolerance")) << check;
      EXPECT_NE(check.at("detail"), "");
    }
    std::set<std::string> expected{"lock-step", "free-running", "passes", "multipliers"};
    if (row.at("scene").get<std::string>().starts_with("four-bar:")) {
      expected.insert({"exact", "convergence-order"});
    }
    const auto variant = select_variants({row.at("implementation").get<std::string>()});
    if (variant.at(0).variant->create_batch != nullptr) expected.insert({"batch", "batch-running"});
    EXPECT_EQ(names, expected);
  }
  for (const std::string& one : left) {  // kernels for chains alone
    EXPECT_TRUE(agreed.contains(one) || one.ends_with(" compiled_chains")) << one;
  }
}

TEST(CheckProgram, AgreesOnScenesWithoutConstraints) {
  if (all_variants().empty()) GTEST_SKIP() << "no implementation is available";
  const std::string scene = test::temporary_path("fall.json");
  std::ofstream(scene) << R"({"dimension": 3, "masses": [{"point": "B", "mass": 2.0}],
    "points": [{"name": "B", "position": [0, 0, 0], "velocity": [1, 2, 0]}]})";
  const auto run = test::run_mbs("check '" + scene + "'");
  EXPECT_EQ(run.status, 0) << run.output << run.errors;
  std::filesystem::remove(scene);
}

TEST(CheckProgram, ALaneThatIsLostAloneTooIsNoDefectOfItsBatch) {
  const auto run = test::run_mbs(
      "check four-bar:10 --implementation compiled_chains/sweeps --scheme rattle6 --steps 40");
  EXPECT_EQ(run.status, 0) << run.output << run.errors;  // lane 8 of 11, at a singular position
}

/// The reference fails with this penalty factor, and would say so.
TEST(CheckProgram, RunsNoReferenceWhereNobodyServesTheScene) {
  const auto run = test::run_mbs("check bodies:2,dimension=3 --penalty 1e300 --implementation minimal_dense");
  EXPECT_EQ(run.status, 1);
  EXPECT_NE(run.errors.find("mbs: nothing was checked"), std::string::npos) << run.errors;
  EXPECT_NE(run.output.find("unsupported"), std::string::npos) << run.output;
}

TEST(CheckProgram, TooFewStepsToJudgeAreNoDisagreement) {
  const Scene scene = load_scene("four-bar:1");
  const StepSettings settings = chosen(scene.model);
  const NamedVariant variant = select_variants({"minimal_dense"}).at(0);
  const Verdict verdict = check_in_process(scene, variant, settings, run_reference(scene, settings), -1.0);
  EXPECT_EQ(verdict.verdict, "timeout");
  EXPECT_NE(verdict.reason.find("0 steps, which agree"), std::string::npos) << verdict.reason;
}

TEST(CheckProgram, KeepsChecksThatWereNotRun) {
  if (all_variants().empty()) GTEST_SKIP() << "no implementation is available";
  const std::string file = test::temporary_path("verdicts.json");
  const auto run = test::run_mbs("check four-bar:1 --step 0.01 --implementation " +
                                 all_variants().front().name + " --json '" + file + "'");
  EXPECT_EQ(run.status, 0) << run.output;
  const json rows = json::parse(test::file_text(file)).at("rows");
  fs::remove(file);
  ASSERT_EQ(rows.size(), 1U);
  for (const json& check : rows[0].at("checks")) {
    const bool is_exact = check.at("name") == "exact" || check.at("name") == "convergence-order";
    EXPECT_EQ(check.at("passed").is_null(), is_exact) << check;
    EXPECT_EQ(check.at("value").is_null(), is_exact) << check;
  }
  EXPECT_NE(run.output.find("not run"), std::string::npos);
}

/// Status 2, nothing on stdout, and one line that has `word` in it on stderr.
void expect_check_refusal(const std::string& arguments, const std::string& word) {
  const auto run = test::run_mbs("check " + arguments);
  EXPECT_EQ(run.status, 2) << arguments;
  EXPECT_EQ(run.output, "") << arguments;
  EXPECT_EQ(std::ranges::count(run.errors, '\n'), 1) << arguments << ": " << run.errors;
  EXPECT_NE(run.errors.find(word), std::string::npos) << arguments << ": " << run.errors;
}

TEST(CheckProgram, RefusesBadInput) {
  if (all_variants().empty()) GTEST_SKIP() << "no implementation is available";
  expect_check_refusal("no-such-scene", "no-such-scene");
  expect_check_refusal("four-bar:0", "four-bar:0");
  expect_check_refusal("four-bar:1 --implementation no_such", "no_such");
  expect_check_refusal("four-bar:1 --no-such-option", "--no-such-option");
  expect_check_refusal("four-bar:1 --step 0", "--step");
  expect_check_refusal("four-bar:1 --step nan", "--step");
  expect_check_refusal("four-bar:1 --penalty -1", "--penalty");
  expect_check_refusal("four-bar:1 --tolerance 0", "--tolerance");
  expect_check_refusal("four-bar:1 --max-passes 0", "--max-passes");
  for (const char* value : {"0", "-1", "nan", "inf", "abc"}) {
    expect_check_refusal(std::string("four-bar:1 --time-limit ") + value, "--time-limit");
  }
  for (const char* value : {"15", "801"}) {
    expect_check_refusal(std::string("four-bar:1 --steps ") + value, "16 to 800");
  }
  expect_check_refusal("four-bar:1 --json /no/such/folder/x.json", "/no/such/folder/x.json");
  expect_check_refusal("--json four-bar:1", "the name of a scene");
}

TEST(CheckProgram, SaysSoIfTheReferenceItselfFails) {
  if (all_variants().empty()) GTEST_SKIP() << "no implementation is available";
  const std::string file = test::temporary_path("verdicts.json");
  expect_check_refusal("four-bar:1 --penalty 1e300 --json '" + file + "'", "the reference fails");
  expect_check_refusal("chain:60 --step 0.1", "the reference fails at t = 0.1 s");
  expect_check_refusal("chain:60 --step 0.1", "choose a shorter step");
  EXPECT_FALSE(fs::exists(file));
  EXPECT_FALSE(fs::exists(file + ".partial"));
}

TEST(CheckProgram, RefusesBoundsThatNothingExceeds) {
  const auto run = test::run_program(
      MBS_CONTROLS,
      "check four-bar:1 --penalty 1e25 --steps 16 --implementation control/reference");
  EXPECT_EQ(run.status, 2) << run.output;
  EXPECT_NE(run.errors.find("nothing can be compared"), std::string::npos) << run.errors;
}

/// A mass that hangs still: its lambda never moves, nor would that of who forgets it.
TEST(CheckProgram, MultipliersThatDoNotMoveAreNotJudged) {
  const test::Folder folder;
  const std::string scene = folder.file("still.json");
  std::ofstream(scene)
      << R"({"masses": [{"point": "B", "mass": 1}], "rods": [{"between": ["A", "B"], "mass": 0}],
    "points": [{"name": "A", "position": [0, 0], "fixed": true}, {"name": "B", "position": [0, -1]}]})";
  const auto run = test::run_program(
      MBS_CONTROLS, "check '" + scene + "' --steps 16 --implementation control/wrong_lambda");
  EXPECT_NE(run.output.find("multipliers        not judged"), std::string::npos) << run.output;
}

TEST(CheckProgram, KeepsWhatWasJudgedBeforeASceneThatIsRefused) {
  const test::Folder folder;
  const std::string scene = folder.file("scene.json"), verdicts = folder.file("verdicts.json");
  std::ofstream(scene) << R"({"masses": [{"point": "B", "mass": 1}],
    "points": [{"name": "A", "position": [0, 0], "fixed": true}, {"name": "B", "position": [0, 1]}],
    "constraints": [{"type": "distance", "between": ["A", "B"],
      "value": {"sine": {"amplitude": 0.001, "offset": 1, "frequency": 100}}}]})";
  const auto run = test::run_program(MBS_CONTROLS, "check four-bar:1 '" + scene +
      "' --implementation control/reference --json '" + verdicts + "'");
  EXPECT_EQ(run.status, 2) << run.output;
  EXPECT_NE(run.errors.find("too fast for --step"), std::string::npos) << run.errors;
  const json rows = json::parse(test::file_text(verdicts)).at("rows");
  ASSERT_EQ(rows.size(), 1U);
  EXPECT_EQ(rows[0].at("scene"), "four-bar:1");
}

TEST(CheckProgram, ARefusedCheckLeavesOlderVerdictsAlone) {
  const std::string file = test::temporary_path("verdicts.json");
  std::ofstream(file) << "precious";
  expect_check_refusal("no-such-scene --json '" + file + "'", "no-such-scene");
  EXPECT_EQ(test::file_text(file), "precious");
  fs::remove(file);
}

}  // namespace
}  // namespace mbs
