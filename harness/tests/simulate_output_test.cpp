// `mbs simulate --output`, and how trajectories, projections and corrections show from outside.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "support/folder.hpp"
#include "support/program.hpp"

namespace mbs {
namespace {

/// A pendulum that starts level, 1.001 m from its pivot instead of 1 m, and asks for three things.
constexpr const char* kPendulum = R"({
  "points": [{"name": "A", "position": [0, 0], "fixed": true}, {"name": "B", "position": [1.001, 0]}],
  "rods": [{"name": "rod", "between": ["A", "B"], "mass": 1, "length": 1}],
  "outputs": [{"name": "tip", "position": "B"}, {"name": "energy", "energy": "total"},
              {"name": "pull", "constraint_force": "rod"}]})";

struct CsvTable {
  std::vector<std::string> columns;
  std::vector<std::vector<double>> rows;
};

CsvTable read_table(const std::string& path) {
  CsvTable table;
  std::istringstream text(test::file_text(path));
  std::string line, part;
  std::getline(text, line);
  for (std::istringstream parts(line); std::getline(parts, part, ',');) {
    table.columns.push_back(part);
  }
  while (std::getline(text, line)) {
    table.rows.emplace_back();
    for (std::istringstream parts(line); std::getline(parts, part, ',');) {
      table.rows.back().push_back(std::strtod(part.c_str(), nullptr));
    }
  }
  return table;
}

class SimulateOutput : public ::testing::Test {
 protected:
  void SetUp() override { std::ofstream(folder_.file("scene.json")) << kPendulum; }

  [[nodiscard]] test::ProgramResult simulate(const std::string& arguments) const {
    return test::run_program(MBS_CONTROLS,
                             "simulate --implementation control/reference " + arguments);
  }
  [[nodiscard]] std::string scene() const { return "'" + folder_.file("scene.json") + "'"; }
  [[nodiscard]] std::string to(const char* option, const char* name) const {
    return std::string(" ") + option + " '" + folder_.file(name) + "'";
  }

  test::Folder folder_;
};

TEST_F(SimulateOutput, WritesWhatTheSceneAsksForAndNothingElse) {
  const auto run = simulate(scene() + " --duration 0.5 --every 100" + to("--output", "out.csv"));
  ASSERT_EQ(run.status, 0) << run.errors;
  const CsvTable table = read_table(folder_.file("out.csv"));
  EXPECT_EQ(table.columns, (std::vector<std::string>{"t", "tip.x", "tip.y", "energy", "pull"}));
  ASSERT_EQ(table.rows.size(), 5u);  // steps 0, 100, 200, 300, 400
  for (std::size_t i = 0; i < 5; ++i) {
    const std::vector<double>& row = table.rows[i];
    ASSERT_EQ(row.size(), 5u);
    EXPECT_NEAR(row[0], 0.125 * static_cast<double>(i), 1e-12);
    EXPECT_NEAR(std::hypot(row[1], row[2]), 1.0, 1e-8);
    EXPECT_NEAR(row[3], 0.0, 2e-3);
    // A rod of 1 kg that fell by h: the multiplier's share of the pull grows with h.
    EXPECT_NEAR(row[4], -0.5 * row[2] * 9.81 + 9.81 * -row[2], 0.02);
  }
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_.file("")), {}), 2);
}

TEST_F(SimulateOutput, WritesBothTables) {
  const auto run = simulate(scene() + " --duration 0.01" + to("--output", "out.csv") +
                            to("--trajectory", "all.csv"));
  ASSERT_EQ(run.status, 0) << run.errors;
  const CsvTable output = read_table(folder_.file("out.csv"));
  const CsvTable trajectory = read_table(folder_.file("all.csv"));
  EXPECT_EQ(trajectory.columns, (std::vector<std::string>{
                                    "t", "A.x", "A.y", "A.vx", "A.vy", "B.x", "B.y", "B.vx", "B.vy",
                                    "kinetic_energy", "potential_energy", "constraint_violation"}));
  ASSERT_EQ(output.rows.size(), 9u);
  ASSERT_EQ(trajectory.rows.size(), 9u);
  for (std::size_t i = 0; i < 9; ++i) {
    EXPECT_EQ(output.rows[i][1], trajectory.rows[i][5]);
    EXPECT_EQ(output.rows[i][3], trajectory.rows[i][9] + trajectory.rows[i][10]);
    EXPECT_LT(trajectory.rows[i][11], 1e-9);
  }
}

TEST_F(SimulateOutput, AFileStaysWhereNothingIsSimulated) {
  ASSERT_EQ(simulate(scene() + " --duration 0.1" + to("--output", "out.csv")).status, 0);
  const std::string before = test::file_text(folder_.file("out.csv"));
  const auto run = test::run_mbs("simulate --implementation minimal_dense --scheme rattle " +
                                 scene() + to("--output", "out.csv"));
  EXPECT_EQ(run.status, 1);
  EXPECT_NE(run.output.find("unsupported"), std::string::npos) << run.output << run.errors;
  EXPECT_EQ(test::file_text(folder_.file("out.csv")), before);
}

TEST_F(SimulateOutput, CompressesWhatEndsInGz) {
  for (const char* name : {"all.csv", "all.csv.gz"}) {
    ASSERT_EQ(simulate(scene() + " --duration 1" + to("--trajectory", name)).status, 0);
  }
  const std::string plain = test::file_text(folder_.file("all.csv"));
  EXPECT_EQ(test::run_program("zcat", "'" + folder_.file("all.csv.gz") + "'").output, plain);
  EXPECT_LT(test::file_text(folder_.file("all.csv.gz")).size(), plain.size() / 2);
}

TEST_F(SimulateOutput, NamesMayBeAsLongAsTheSystemAllows) {
  for (const std::size_t length : {200U, 236U, 255U}) {
    const std::string name = std::string(length - 4, 'x') + ".csv";
    const auto run = simulate(scene() + " --duration 0.01" + to("--output", name.c_str()));
    EXPECT_EQ(run.status, 0) << length << run.errors;
    EXPECT_EQ(read_table(folder_.file(name)).rows.size(), 9u);
  }
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_.file("")), {}), 4);
}

TEST_F(SimulateOutput, LeavesNothingBehindWhereItsReaderLeaves) {
  const std::string command =
      "'" MBS_CONTROLS "' simulate --implementation control/reference --duration 5 --step 1e-3 " +
      scene() + to("--trajectory", "all.csv") +
      " --output /dev/stdout | head -n 1";  // more than a pipe holds
  EXPECT_EQ(std::system(command.c_str()), 0);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_.file("")), {}), 1);
}

TEST_F(SimulateOutput, WarnsOfForcesThatConstraintsLeaveOpen) {
  const std::string square = folder_.file("square.json");
  std::ofstream(square) << R"({"points": [{"name": "O", "position": [0, 0], "fixed": true},
      {"name": "A", "position": [1, 0]}, {"name": "B", "position": [1, 1]}, {"name": "C", "position": [0, 1]}],
    "rods": [{"name": "OA", "between": ["O", "A"], "mass": 1}, {"between": ["A", "B"], "mass": 1},
      {"between": ["B", "C"], "mass": 1}, {"between": ["C", "O"], "mass": 1}, {"between": ["O", "B"], "mass": 1},
      {"between": ["A", "C"], "mass": 1}], "outputs": [{"name": "pull", "constraint_force": "OA"}]})";
  const auto run = simulate("'" + square + "' --duration 0.01");
  EXPECT_NE(run.errors.find("mbs: warning: outputs \"pull\":"), std::string::npos) << run.errors;
}

TEST_F(SimulateOutput, SaysWhatTheStartNeeded) {
  const auto run = simulate(scene() + " --duration 0.01 --json");
  ASSERT_EQ(run.status, 0) << run.errors;
  const auto assembly = nlohmann::json::parse(run.output).at("assembly");
  EXPECT_NEAR(assembly.at("position_correction").get<double>(), 0.001, 1e-9);
  EXPECT_EQ(assembly.at("point"), "B");
  EXPECT_NE(simulate(scene() + " --duration 0.01").output.find("points moved by up to 0.001 m (B)"),
            std::string::npos);
}

TEST_F(SimulateOutput, RefusesASceneWithoutOutputs) {
  const auto run =
      simulate(MBS_ROOT "/harness/scenes/pendulum.json --duration 0.1" + to("--output", "out.csv"));
  EXPECT_EQ(run.status, 2);
  EXPECT_EQ(std::ranges::count(run.errors, '\n'), 1) << run.errors;
  EXPECT_NE(run.errors.find("--trajectory"), std::string::npos) << run.errors;
  EXPECT_FALSE(std::filesystem::exists(folder_.file("out.csv")));
}

TEST_F(SimulateOutput, RefusesOneFileForBoth) {
  const auto run = simulate(scene() + to("--output", "out.csv") + to("--trajectory", "out.csv"));
  EXPECT_EQ(run.status, 2);
  EXPECT_NE(run.errors.find("same file"), std::string::npos) << run.errors;
  const std::string one(300, 'a'), other(300, 'b');  // longer than a name may be
  const auto longer =
      simulate(scene() + to("--output", one.c_str()) + to("--trajectory", other.c_str()));
  EXPECT_NE(longer.errors.find("too long"), std::string::npos) << longer.errors;
  const auto empty = simulate(scene() + " --output ''");
  EXPECT_EQ(empty.status, 2);
  EXPECT_NE(empty.errors.find("--output"), std::string::npos) << empty.errors;
}

TEST_F(SimulateOutput, ProjectionsAreAChoice) {
  std::vector<double> violations;
  for (const char* choice : {"none", "velocity", "both"}) {
    const auto run =
        simulate(scene() + " --duration 1 --json --projections " + std::string(choice));
    ASSERT_EQ(run.status, 0) << choice << run.errors;
    const auto summary = nlohmann::json::parse(run.output);
    EXPECT_EQ(summary.at("projections"), choice);
    violations.push_back(summary.at("energy_drift_max"));
  }
  EXPECT_NE(violations[0], violations[1]);
  EXPECT_NE(violations[1], violations[2]);
  const auto bad = simulate(scene() + " --projections some");
  EXPECT_EQ(bad.status, 2);
  EXPECT_NE(bad.errors.find("--projections"), std::string::npos) << bad.errors;
}

}  // namespace
}  // namespace mbs
