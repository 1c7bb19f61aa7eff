// `mbs sweep` from the outside: its table, its exit status, its errors.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "support/folder.hpp"
#include "support/program.hpp"

namespace mbs {
namespace {

using Row = std::map<std::string, std::string>;

/// Cells of one line of CSV.
std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells{""};
  bool quoted = false;
  for (const char c : line) {
    if (c == '"') {
      quoted = !quoted;
    } else if (c == ',' && !quoted) {
      cells.emplace_back();
    } else {
      cells.back() += c;
    }
  }
  return cells;
}

/// The rows of a CSV file by column name, all of one length.
std::vector<Row> rows_of(const std::string& path) {
  std::istringstream text(test::file_text(path));
  std::string line;
  std::getline(text, line);
  const std::vector<std::string> columns = cells_of(line);
  std::vector<Row> rows;
  while (std::getline(text, line)) {
    const std::vector<std::string> cells = cells_of(line);
    EXPECT_EQ(cells.size(), columns.size()) << line;
    Row row;
    for (std::size_t i = 0; i < columns.size(); ++i) row[columns[i]] = cells.at(i);
    EXPECT_EQ(row.size(), columns.size()) << "a column's name is there twice";
    rows.push_back(std::move(row));
  }
  return rows;
}

class SweepProgram : public ::testing::Test {
 protected:
  [[nodiscard]] test::ProgramResult sweep(const std::string& arguments,
                                          const std::string& variant = "batch/sound") const {
    return test::run_program(MBS_CONTROLS, "sweep --implementation " + variant + " --output '" +
                                               file_ + "' " + arguments);
  }
  void expect_refusal(const std::string& arguments, const std::vector<std::string>& words) const {
    const auto run = sweep(arguments);
    EXPECT_EQ(run.status, 2) << arguments;
    EXPECT_EQ(run.output, "") << arguments;
    EXPECT_EQ(std::ranges::count(run.errors, '\n'), 1) << run.errors;
    for (const std::string& word : words) {
      EXPECT_NE(run.errors.find(word), std::string::npos) << word << " is not in " << run.errors;
    }
    EXPECT_TRUE(folder_.is_empty()) << arguments;
  }

  test::Folder folder_;
  std::string file_ = folder_.file("out.csv");
};

TEST_F(SweepProgram, WritesARowALane) {
  const auto run =
      sweep("four-bar:2 --duration 0.1 --vary gravity/1=-12:-6:3 --vary rods/A0-B0/mass=1,2");
  EXPECT_EQ(run.status, 0) << run.errors;
  EXPECT_EQ(run.output, "6 lanes: 6 plausible\n");
  EXPECT_EQ(run.errors, "");
  const std::string text = test::file_text(file_);
  EXPECT_EQ(text.substr(0, text.find('\n')),
            "gravity/1,rods/A0-B0/mass,status,status_reason,failed_at,steps,passes_per_step,"
            "position_error_estimate,local_error_sum,energy_drift_max,imbalance_max,constraint_violation_max,"
            "B0.x.last,B0.x.min,B0.x.max,B0.y.last,B0.y.min,B0.y.max,"
            "vB0.vx.last,vB0.vx.min,vB0.vx.max,vB0.vy.last,vB0.vy.min,vB0.vy.max");
  const std::vector<Row> rows = rows_of(file_);
  ASSERT_EQ(rows.size(), 6U);
  const char* gravity[] = {"-12", "-12", "-9", "-9", "-6", "-6"};
  for (std::size_t i = 0; i < 6; ++i) {
    const Row& row = rows[i];
    EXPECT_EQ(row.at("gravity/1"), gravity[i]);
    EXPECT_EQ(row.at("rods/A0-B0/mass"), i % 2 == 0 ? "1" : "2");
    EXPECT_EQ(row.at("status"), "plausible");
    EXPECT_NE(row.at("status_reason").find("--half-step"), std::string::npos);
    EXPECT_EQ(row.at("failed_at"), "");
    EXPECT_EQ(row.at("steps"), "80");
    EXPECT_EQ(row.at("position_error_estimate"), "");
    for (const char* figure : {"passes_per_step", "local_error_sum", "energy_drift_max",
                               "constraint_violation_max", "B0.x.last", "vB0.vx.max"}) {
      EXPECT_GT(std::stod(row.at(figure)), 0.0) << figure;
    }
    EXPECT_EQ(row.at("B0.y.max"), "1");  // at the start
    EXPECT_LT(std::stod(row.at("B0.y.min")), 1.0);
  }
  EXPECT_LT(std::stod(rows[0].at("B0.y.min")), std::stod(rows[4].at("B0.y.min")));
}

TEST_F(SweepProgram, HasTheFiguresOfSimulate) {
  ASSERT_EQ(sweep("four-bar:2 --duration 0.5 --half-step --vary gravity/1=-9.81").status, 0);
  const std::vector<Row> rows = rows_of(file_);
  const auto run =
      test::run_program(MBS_CONTROLS,
                        "simulate four-bar:2 --duration 0.5 --half-step --json --implementation "
                        "control/reference");
  const auto summary = nlohmann::json::parse(run.output);
  for (const char* figure : {"passes_per_step", "position_error_estimate", "energy_drift_max",
                             "constraint_violation_max"}) {
    EXPECT_EQ(std::stod(rows.at(0).at(figure)), summary.at(figure).get<double>()) << figure;
  }
}

TEST_F(SweepProgram, CountsTheLanesThatFailAndWritesThemAll) {
  const std::string arguments = "four-bar:1 --duration 0.25 --vary gravity/1=-12:-2:6";
  const auto run = sweep(arguments, "batch/lost_lane");
  EXPECT_EQ(run.status, 1);
  EXPECT_EQ(run.output, "");
  EXPECT_EQ(run.errors,
            "mbs: batch/lost_lane on four-bar:1: 2 of 6 lanes failed: 4 plausible, 2 diverged "
            "(column status_reason says why)\n");
  const std::vector<Row> lost = rows_of(file_);
  ASSERT_EQ(sweep(arguments).status, 0);
  const std::vector<Row> sound = rows_of(file_);
  ASSERT_EQ(lost.size(), 6U);
  for (std::size_t i = 0; i < 6; ++i) {
    if (i % 4 != 1) {
      EXPECT_EQ(lost[i], sound[i]) << i;
      continue;
    }
    EXPECT_EQ(lost[i].at("status"), "diverged");
    EXPECT_EQ(lost[i].at("status_reason"), "the state is not finite");
    EXPECT_GT(std::stod(lost[i].at("failed_at")), 0.05 - 1e-9);
    EXPECT_EQ(lost[i].at("constraint_violation_max"), "");
    EXPECT_EQ(lost[i].at("B0.x.max"), "");
  }
}

TEST_F(SweepProgram, ALaneThatCannotBeAssembledHasItsRow) {
  const auto run =
      sweep("four-bar:2 --duration 0.1 --vary rods/A0-B0/length=1,3,1 --vary gravity/1=-9,-8",
            "batch/sound");
  EXPECT_EQ(run.status, 1);
  EXPECT_NE(run.errors.find("2 of 6 lanes failed: 4 plausible, 2 not-assembled"), std::string::npos)
      << run.errors;
  const std::vector<Row> rows = rows_of(file_);
  ASSERT_EQ(rows.size(), 6U);
  for (const std::size_t i : {2U, 3U}) {
    EXPECT_EQ(rows[i].at("status"), "not-assembled");
    EXPECT_NE(rows[i].at("status_reason").find("would move by"), std::string::npos);
    EXPECT_EQ(rows[i].at("steps"), "");
  }
  EXPECT_EQ(rows[4].at("B0.y.min"), rows[0].at("B0.y.min"));
}

TEST_F(SweepProgram, SaysWhereLanesRanOneAfterTheOther) {
  const std::string arguments = "four-bar:1 --duration 0.1 --vary gravity/1=-9,-8";
  EXPECT_EQ(sweep(arguments, "batch/lost_lane").errors.find("one after the other"),
            std::string::npos);
  const auto run = test::run_program(
      MBS_PROGRAM, "sweep --implementation compiled_ldl/fronts --scheme saddle-point --output '" +
                       file_ + "' " + arguments);
  EXPECT_NE(run.errors.find("note: lanes ran one after the other: compiled_ldl/fronts"),
            std::string::npos)
      << run.errors;
}

TEST_F(SweepProgram, AnUnsupportedSceneHasRowsToo) {
  const auto run = sweep("four-bar:2 --duration 0.1 --vary gravity/1=-9,-8", "control/unsupported");
  EXPECT_EQ(run.status, 1);
  EXPECT_NE(run.errors.find("2 of 2 lanes failed: 2 unsupported"), std::string::npos) << run.errors;
  for (const Row& row : rows_of(file_)) {
    EXPECT_EQ(row.at("status"), "unsupported");
    EXPECT_EQ(row.at("steps"), "0");
    EXPECT_EQ(row.at("passes_per_step"), "");
    EXPECT_EQ(row.at("energy_drift_max"), "");
  }
}

TEST_F(SweepProgram, VariesAFileWhereNamesAreUsed) {
  const std::string scene = MBS_ROOT "/harness/scenes/point_mass_pendulum.json";
  const auto run = sweep("'" + scene + "' --duration 0.1 --vary masses/B/mass=1:100:3:log");
  EXPECT_EQ(run.status, 0) << run.errors;
  const std::vector<Row> rows = rows_of(file_);
  ASSERT_EQ(rows.size(), 3U);
  EXPECT_EQ(rows[1].at("masses/B/mass"), "10");
  EXPECT_EQ(rows[2].count("B.x.last"), 0U);  // it names no outputs
}

TEST_F(SweepProgram, RefusesBadInputBeforeAnythingRuns) {
  const std::string vary = "four-bar:2 --vary ";
  expect_refusal("four-bar:2", {"--vary"});
  expect_refusal(vary + "gravity/1", {"PATH=RANGE"});
  expect_refusal(vary + "gravity/1=1:2", {"a:b:K"});
  expect_refusal(vary + "gravity/1=1:2:3 --vary gravity/1=1", {"the same number"});
  expect_refusal(vary + "gravity/1=1:2:1000 --vary gravity/0=1:2:1001", {"1000000 lanes"});
  expect_refusal(vary + "rods/A0-B0/mass=1,-1",
                 {"lane 2 of 2 (rods/A0-B0/mass = -1): ", "four-bar:2: rods[0].mass: found -1"});
  expect_refusal(vary + "gravity/1=1 --step 0", {"--step is 0"});
  expect_refusal(vary + "gravity/1=uniform:1:2 --sample 2 --seed -1", {"--seed", "-1"});
  expect_refusal(vary + "gravity/1=1 --duration -1", {"mbs: --duration is -1"});
  expect_refusal("four-bar:2,fill=0.9 --vary gravity/1=1", {"fill"});
  expect_refusal("nowhere.json --vary gravity/1=1", {"nowhere.json"});
  const auto run = test::run_program(
      MBS_PROGRAM, "sweep --implementation csc_klu/refactor --output - " + vary + "gravity/1=1");
  EXPECT_EQ(run.status, 2);
  EXPECT_NE(run.errors.find("'-'"), std::string::npos) << run.errors;
  const std::string scene = MBS_ROOT "/harness/scenes/point_mass_pendulum.json";
  expect_refusal("'" + scene + "' --vary masses/C/mass=1,2", {"no \"C\" in masses", "one of B"});
}

TEST_F(SweepProgram, ChecksAllLanesOfAllPartsBeforeTheyRun) {
  const auto check = [](const std::string& arguments) {
    return test::run_program(MBS_CONTROLS,
                             "sweep --implementation batch/sound four-bar:1 " + arguments);
  };
  const std::string good = "--vary rods/A0-B0/length=1,3 --vary gravity/1=-9,-8,-7 ";
  const auto sound = check(good + "--check");
  EXPECT_EQ(sound.status, 0) << sound.errors;
  EXPECT_EQ(sound.output, "6 lanes: no value is refused\n");
  EXPECT_EQ(check(good + "--check --shard 2/2").output, "2 lanes: no value is refused\n");
  const std::string bad = "--duration 0.1 --vary rods/A0-B0/mass=1,1,1,1,1,1,1,-1 ";
  for (const char* jobs : {"1", "2"}) {
    const auto refused = check(bad + "--check --jobs " + jobs);
    EXPECT_EQ(refused.status, 2);
    EXPECT_EQ(refused.output, "");
    EXPECT_NE(refused.errors.find("lane 8 of 8 (rods/A0-B0/mass = -1): "), std::string::npos)
        << refused.errors;
  }
  EXPECT_EQ(check(bad + "--check --shard 1/2").status, 0);
  EXPECT_EQ(sweep("four-bar:1 " + bad + "--check").status, 2);
  EXPECT_TRUE(folder_.is_empty());
  const auto none = check(good);
  EXPECT_EQ(none.status, 2);
  EXPECT_NE(none.errors.find("--output is required"), std::string::npos) << none.errors;
}

TEST_F(SweepProgram, WhatItSaysComesBehindATableOnStandardOutput) {
  file_ = "/dev/stdout";  // here a file
  const auto run = sweep("four-bar:1 --duration 0.1 --vary gravity/1=-9,-8");
  EXPECT_TRUE(run.output.starts_with("gravity/1,status,")) << run.output;
  EXPECT_TRUE(run.output.ends_with("\n2 lanes: 2 plausible\n")) << run.output;
}

TEST_F(SweepProgram, WritesWholeTablesOnly) {
  std::ofstream(file_) << "mine\n";
  EXPECT_EQ(sweep("four-bar:2 --vary rods/A0-B0/mass=1,-1").status, 2);
  EXPECT_EQ(test::file_text(file_), "mine\n");
  const std::string scene = folder_.file("scene.json");
  std::ofstream(scene) << test::file_text(MBS_ROOT "/harness/scenes/pendulum.json");
  const auto run = test::run_program(
      MBS_CONTROLS, "sweep '" + scene + "' --implementation batch/sound --vary gravity/1=1 " +
                        "--output '" + scene + "'");
  EXPECT_EQ(run.status, 2);
  EXPECT_NE(run.errors.find("the scene's own file"), std::string::npos) << run.errors;
}

}  // namespace
}  // namespace mbs
