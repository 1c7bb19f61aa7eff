// `mbs simulate` from the outside: its summary, its trajectories, its errors.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "model_math/kinematics.hpp"
#include "registry/registry.hpp"
#include "run/run.hpp"
#include "scene_file/load_scene.hpp"
#include "support/folder.hpp"
#include "support/program.hpp"

namespace mbs {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

class SimulateProgram : public ::testing::Test {
 protected:
  void SetUp() override {
    if (all_variants().empty()) GTEST_SKIP() << "no implementation is available";
    variant_ = all_variants().front().name;
  }
  [[nodiscard]] test::ProgramResult simulate(const std::string& arguments) const {
    return test::run_mbs("simulate --implementation " + variant_ + " " + arguments);
  }
  /// Status 2, nothing on stdout, and one line that has `word` in it on stderr.
  void expect_refusal(const std::string& arguments, const std::string& word) const {
    expect_one_line(simulate(arguments), arguments, word);
  }
  static void expect_one_line(const test::ProgramResult& run, const std::string& arguments,
                              const std::string& word) {
    EXPECT_EQ(run.status, 2) << arguments;
    EXPECT_EQ(run.output, "") << arguments;
    EXPECT_EQ(std::ranges::count(run.errors, '\n'), 1) << arguments << ": " << run.errors;
    EXPECT_TRUE(run.errors.starts_with("mbs: ") && run.errors.ends_with('\n')) << run.errors;
    EXPECT_NE(run.errors.find(word), std::string::npos) << arguments << ": " << run.errors;
  }

  std::string variant_;
};

// A rod of a milligram below one of a kilogram: scaled, the equations are others.
TEST_F(SimulateProgram, WarnsOfScaledEquationsByThese) {
  const test::Folder folder;
  const std::string scene = folder.file("light.json");
  std::ofstream(scene) << R"({"points": [{"name": "A", "position": [0, 0], "fixed": true},
    {"name": "B", "position": [0.8, -0.6]}, {"name": "C", "position": [1.6, -1.2]}],
    "rods": [{"between": ["A", "B"], "mass": 1}, {"between": ["B", "C"], "mass": 1e-6}]})";
  const std::string arguments = "'" + scene + "' --duration 0.1 --json --scale-equations";
  const json automatic = json::parse(simulate(arguments).output);
  EXPECT_EQ(automatic.at("warnings"), json::array());
  const std::string penalty = automatic.at("penalty").dump();
  const json same = json::parse(simulate(arguments + " --penalty " + penalty).output);
  EXPECT_EQ(same.at("penalty"), automatic.at("penalty"));
  EXPECT_EQ(same.at("warnings"), json::array());
}

TEST_F(SimulateProgram, WarnsWhereAlmostNothingIsJudged) {
  const std::string arguments = "four-bar:1 --duration 0.5 --judge-every ";
  const auto seldom = simulate(arguments + "100000");
  EXPECT_EQ(seldom.status, 0);
  EXPECT_NE(seldom.errors.find("--judge-every 100000 judges 1 of 400 steps"), std::string::npos)
      << seldom.errors;
  EXPECT_EQ(simulate(arguments + "20").errors, "");
}

/// Page faults of the children that have ended.
long page_faults_of_children() {
  rusage usage{};
  getrusage(RUSAGE_CHILDREN, &usage);
  return usage.ru_minflt;
}

// Eigen takes workspace from the heap in each factorization of this size.
TEST_F(SimulateProgram, StepsTakeNoNewPages) {
#if defined(__SANITIZE_ADDRESS__)
  GTEST_SKIP() << "this allocator has no limit to set";
#endif
  std::vector<long> faults;
  for (const std::string duration : {"0.02", "0.12"}) {
    const long before = page_faults_of_children();
    const auto run = test::run_mbs(
        "simulate grid:10x10 --implementation eigen_dense/llt --step 1e-3 --duration " + duration);
    ASSERT_EQ(run.status, 0) << run.errors;
    faults.push_back(page_faults_of_children() - before);
  }
  EXPECT_LT(faults[1] - faults[0], 1000);  // ten a step
}

TEST_F(SimulateProgram, SummaryHasEveryField) {
  const auto run = simulate("four-bar:3 --duration 0.5 --penalty 1e8 --tolerance 1e-8 --json");
  EXPECT_EQ(run.status, 0);
  EXPECT_EQ(run.errors, "");
  const json summary = json::parse(run.output);
  EXPECT_EQ(summary.at("scene"), "four-bar:3");
  EXPECT_EQ(summary.at("implementation"), variant_);
  EXPECT_EQ(summary.at("variables"), 8);
  EXPECT_EQ(summary.at("constraints"), 7);
  EXPECT_EQ(summary.at("tangent_nonzeros"), 40);  // four blocks on the diagonal, three beside it
  EXPECT_EQ(summary.at("step"), 1.25e-3);
  EXPECT_EQ(summary.at("duration"), 0.5);
  EXPECT_EQ(summary.at("penalty"), 1e8);
  EXPECT_EQ(summary.at("tolerance"), 1e-8);
  EXPECT_EQ(summary.at("projections"), "both");
  EXPECT_EQ(summary.at("assembly").at("position_correction"), 0.0);
  EXPECT_EQ(summary.at("status"), "ok");
  EXPECT_EQ(summary.at("status_reason"), "");
  EXPECT_TRUE(summary.at("failed_at").is_null());
  EXPECT_EQ(summary.at("steps"), 400);
  EXPECT_GE(summary.at("passes_per_step"), 1.0);
  EXPECT_LE(summary.at("passes_per_step"), 20.0);
  for (const char* figure :
       {"position_error_max", "energy_drift_max", "constraint_violation_max", "setup_us"}) {
    EXPECT_GT(summary.at(figure), 0.0) << figure;
  }
  EXPECT_LT(summary.at("position_error_max"), 1e-4);
  EXPECT_GT(summary.at("step_us").at("median"), 0.0);
  EXPECT_GE(summary.at("step_us").at("p99"), summary.at("step_us").at("median"));
  EXPECT_GE(summary.at("step_us").at("max"), summary.at("step_us").at("p99"));
}

TEST_F(SimulateProgram, TextNamesTheStatus) {
  const auto run = simulate("four-bar:1 --duration 0.1");
  EXPECT_EQ(run.status, 0);
  EXPECT_EQ(run.errors, "");
  EXPECT_TRUE(run.output.starts_with(variant_ + " on four-bar:1\n  status                 ok\n"))
      << run.output;
}

TEST_F(SimulateProgram, HasNoPositionErrorWithoutAnExactSolution) {
  const std::string scene = MBS_ROOT "/harness/scenes/double_pendulum.json";
  const auto run = simulate("'" + scene + "' --duration 0.2 --json");
  EXPECT_EQ(run.status, 0) << run.errors;
  EXPECT_TRUE(json::parse(run.output).at("position_error_max").is_null());
  EXPECT_NE(simulate("'" + scene + "' --duration 0.2")
                .output.find("\n  status                 plausible: no exact motion is known"),
            std::string::npos);
}

TEST_F(SimulateProgram, EveryImplementationRuns) {
  for (const NamedVariant& variant : all_variants()) {
    const auto run =
        test::run_mbs("simulate four-bar:2 --duration 0.5 --json --implementation " + variant.name);
    EXPECT_EQ(run.status, 0) << variant.name << ": " << run.errors;
    EXPECT_EQ(json::parse(run.output).at("implementation"), variant.name);
  }
}

TEST_F(SimulateProgram, ADivergedRunStillHasItsSummary) {
  const auto run = simulate("four-bar:40 --penalty 1e8 --json");
  EXPECT_EQ(run.status, 1);
  const json summary = json::parse(run.output);
  EXPECT_EQ(summary.at("status"), "diverged");
  EXPECT_NE(summary.at("status_reason"), "");
  EXPECT_GT(summary.at("failed_at"), 0.1);
  EXPECT_LT(summary.at("failed_at"), 20.0);
  EXPECT_LT(summary.at("steps"), 16'000);
  EXPECT_TRUE(run.errors.starts_with("mbs: " + variant_ + " on four-bar:40: diverged at t = "));
  EXPECT_EQ(std::ranges::count(run.errors, '\n'), 1) << run.errors;
}

TEST_F(SimulateProgram, SaysWhichFiguresAreNotKnown) {
  const auto expect = [](const test::ProgramResult& run, const std::string& line) {
    EXPECT_NE(run.output.find("  " + line + "\n"), std::string::npos) << line << "\n" << run.output;
  };
  const std::string scenes = "'" MBS_ROOT "/harness/scenes/";
  const std::string pendulum = scenes + "double_pendulum.json' --duration 1 --step 0.5 --half-step";
  const std::string unknown = "position error max     not known: this scene has no exact motion";
  const auto lost = simulate(pendulum);
  EXPECT_EQ(lost.status, 1);
  expect(lost, unknown);
  expect(lost, "estimated error max    not known: the run was lost");
  const auto damped = simulate(scenes + "problems/half_car.json' --duration 0.1");
  EXPECT_NE(damped.output.find("  energy off the work by "), std::string::npos) << damped.output;
  const auto early = simulate(scenes + "problems/a05_governor.json' --duration 2 --step 1");
  EXPECT_EQ(early.status, 1);
  expect(early, "energy off the work by not known: the run was lost");
  const auto driven = simulate(scenes + "examples/driven_crank.json' --duration 0.1");
  expect(driven, unknown + " (--half-step estimates it)");
  expect(driven, "energy drift max       not judged: drivers alone set the motion");
  const auto failed = simulate("four-bar:10 --duration 1 --penalty 1e300");
  EXPECT_EQ(failed.status, 1);
  expect(failed, "position error max     not known: the run was lost");
  expect(failed, "energy drift max       not known: the run was lost");
  const auto refused =
      test::run_program(MBS_CONTROLS, "simulate four-bar:2 --implementation control/unsupported");
  EXPECT_TRUE(refused.output.ends_with("  steps                  none was done\n"));
}

TEST_F(SimulateProgram, HelpDefinesTheOutcomes) {
  for (const char* command : {"simulate", "sweep"}) {
    const auto help = test::run_mbs(command + std::string(" --help"));
    EXPECT_EQ(help.status, 0);
    for (const Outcome& outcome : outcomes()) {
      EXPECT_NE(help.output.find("\n  " + outcome.name + " "), std::string::npos) << outcome.name;
      EXPECT_NE(help.output.find(outcome.meaning), std::string::npos) << outcome.meaning;
    }
  }
}

TEST_F(SimulateProgram, RefusesEmptyValues) {
  for (const char* option : {"--step", "--judge-every", "--deadline-us", "--repeats", "--every",
                             "--output", "--trajectory", "--max-passes"}) {
    expect_refusal(std::string("four-bar:2 ") + option + " ''",
                   std::string(option) + ": the value is empty");
  }
  expect_refusal("''", "scene: the value is empty");
  expect_one_line(test::run_mbs("bench four-bar:2 --start ''"), "bench", "--start: the value is");
  expect_one_line(test::run_mbs("check --time-limit ''"), "check", "--time-limit: the value is");
  expect_one_line(test::run_mbs("limit ''"), "limit", "N: the value is empty");
}

TEST_F(SimulateProgram, ARunThatDoesNotConvergeSaysSo) {
  const auto run = simulate("four-bar:2 --duration 0.2 --tolerance 1e-15 --max-passes 1 --json");
  EXPECT_EQ(run.status, 1);
  EXPECT_EQ(json::parse(run.output).at("status"), "not-converged");
  EXPECT_NE(run.errors.find("160 of 160 steps ended at the limit"), std::string::npos);
  EXPECT_EQ(std::ranges::count(run.errors, '\n'), 1) << run.errors;
}

TEST_F(SimulateProgram, AnUnsupportedSceneHasASummaryToo) {
  const auto run = test::run_program(
      MBS_CONTROLS, "simulate four-bar:2 --implementation control/unsupported --json");
  EXPECT_EQ(run.status, 1);
  const json summary = json::parse(run.output);
  EXPECT_EQ(summary.at("status"), "unsupported");
  EXPECT_EQ(summary.at("steps"), 0);
}

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, separator);) parts.push_back(part);
  return parts;
}

double largest_violation(const Model& model, double t, const std::vector<double>& q) {
  std::vector<double> phi(static_cast<std::size_t>(model.constraints()));
  evaluate_constraints(model, t, q, phi);
  double largest = 0.0;
  for (const double value : phi) largest = std::max(largest, std::abs(value));
  return largest;
}

TEST_F(SimulateProgram, TrajectoryHasTheStatesToTheLastBit) {
  const test::Folder folder;
  const std::string file = folder.file("out.csv");
  const std::string options = "four-bar:1 --duration 0.01 --penalty 1e8 --tolerance 1e-9 ";
  ASSERT_EQ(simulate(options + "--every 3 --trajectory '" + file + "'").status, 0);
  EXPECT_FALSE(fs::exists(file + ".partial"));
  const auto lines = split(test::file_text(file), '\n');
  ASSERT_EQ(lines.size(), 4U);  // the header, and the steps 0, 3 and 6 of 8
  EXPECT_EQ(lines[0],
            "t,A0.x,A0.y,A0.vx,A0.vy,A1.x,A1.y,A1.vx,A1.vy,"
            "B0.x,B0.y,B0.vx,B0.vy,B1.x,B1.y,B1.vx,B1.vy,"
            "kinetic_energy,potential_energy,constraint_violation");

  std::vector<std::vector<double>> expected;
  RunSettings settings;
  settings.step = {.penalty = 1e8, .tolerance = 1e-9};
  settings.duration = 0.01;
  const Scene scene = load_scene("four-bar:1");
  run(scene, *all_variants().front().variant, settings,
      [&](long step, double t, const State& state) {
        if (step % 3 != 0) return;
        const auto &q = state.q, &v = state.v;
        expected.push_back({t,
                            0.0,
                            0.0,
                            0.0,
                            0.0,
                            1.0,
                            0.0,
                            0.0,
                            0.0,
                            q[0],
                            q[1],
                            v[0],
                            v[1],
                            q[2],
                            q[3],
                            v[2],
                            v[3],
                            kinetic_energy(scene.model, v),
                            potential_energy(scene.model, t, q),
                            largest_violation(scene.model, t, q)});
      });
  for (std::size_t row = 0; row < 3; ++row) {
    std::vector<double> numbers;
    for (const std::string& text : split(lines[row + 1], ',')) {
      numbers.push_back(std::strtod(text.c_str(), nullptr));
    }
    EXPECT_EQ(numbers, expected[row]) << row;
  }
}

TEST_F(SimulateProgram, TrajectoryOfADivergedRunHasWhatCameBefore) {
  const test::Folder folder;
  const std::string file = folder.file("out.csv");
  EXPECT_EQ(simulate("four-bar:3 --penalty 1e-3 --trajectory '" + file + "'").status, 1);
  const auto lines = split(test::file_text(file), '\n');
  EXPECT_GT(lines.size(), 2U);
  for (const std::string& line : lines) EXPECT_EQ(line.find("nan"), std::string::npos) << line;
}

TEST_F(SimulateProgram, ARefusedRunLeavesNothingBehind) {
  const test::Folder folder;
  const std::string to_file = " --trajectory '" + folder.file("out.csv") + "'";
  expect_refusal("four-bar:2 --step 0" + to_file, "--step");
  expect_refusal("four-bar:2 --every 0" + to_file, "--every");
  expect_refusal("four-bar:0" + to_file, "four-bar:0");
  expect_refusal("four-bar:2 --penalty x" + to_file, "--penalty");
  EXPECT_TRUE(folder.is_empty());
}

TEST_F(SimulateProgram, ARefusedRunLeavesOlderFilesAlone) {
  const test::Folder folder;
  const std::string file = folder.file("out.csv");
  std::ofstream(file) << "precious";
  expect_refusal("four-bar:2 --duration 0 --trajectory '" + file + "'", "--duration");
  EXPECT_EQ(test::file_text(file), "precious");
}

TEST_F(SimulateProgram, NeverWritesOverItsSceneOrOneTableOverTheOther) {
  const test::Folder folder;
  const std::string scene = folder.file("s.json"), link = folder.file("link.csv");
  fs::copy_file(MBS_ROOT "/harness/scenes/pendulum.json", scene);
  const std::string text = test::file_text(scene);
  fs::create_symlink(scene, link);
  const std::string run = "'" + scene + "' --duration 0.01 ";
  for (const std::string& file : {scene, folder.file("./s.json"), link}) {
    expect_refusal(run + "--output '" + file + "'",
                   "--output: found \"" + file + "\", the scene's");
    expect_refusal(run + "--trajectory '" + file + "'", "--trajectory: found");
    const auto check = test::run_mbs("check --json '" + file + "' '" + scene + "'");
    expect_one_line(check, "check", "--json: found");
    const auto bench = test::run_mbs("bench --benchmark_out='" + file + "' '" + scene + "'");
    expect_one_line(bench, "bench", "--benchmark_out: found");
  }
  EXPECT_EQ(test::file_text(scene), text);
  expect_refusal(
      run + "--output '" + folder.file("o.csv") + "' --trajectory '" + folder.file("./o.csv") + "'",
      "the same file");
  EXPECT_FALSE(fs::exists(folder.file("o.csv")));
  expect_refusal("four-bar:1 --every 2", "--every is for --output and --trajectory");
}

TEST_F(SimulateProgram, WarnsOfSettingsFarOutsideTheWindow) {
  const auto run = simulate("four-bar:1 --duration 0.01 --penalty 1e-300 --json");
  EXPECT_EQ(run.status, 0);
  EXPECT_TRUE(run.errors.starts_with("mbs: warning: the penalty factor 1e-300 is far below "))
      << run.errors;
  EXPECT_EQ(std::ranges::count(run.errors, '\n'), 1) << run.errors;
  EXPECT_EQ(json::parse(run.output).at("warnings").size(), 1u);
  const auto lost = simulate("four-bar:40 --penalty 1e-3");
  EXPECT_EQ(lost.status, 1);
  EXPECT_NE(lost.errors.find("(the penalty factor 0.001 is far below"), std::string::npos);
  EXPECT_EQ(std::ranges::count(lost.errors, '\n'), 1) << lost.errors;
}

TEST_F(SimulateProgram, RefusesUnwritableOutput) {
  const test::Folder folder;
  const std::string missing = folder.file("none/out.csv");
  expect_refusal("four-bar:2 --trajectory '" + missing + "'", missing);
  fs::create_directory(folder.file("taken"));
  expect_refusal("four-bar:2 --trajectory '" + folder.file("taken") + "'", "taken");
}

// Through links of our own, so that a defect could only replace those.
TEST_F(SimulateProgram, WritesToDevicesWithoutReplacingThem) {
  const test::Folder folder;
  const std::string null = folder.file("null");
  fs::create_symlink("/dev/null", null);
  for (const std::string& full : {folder.file("full"), folder.file("full.gz")}) {
    fs::create_symlink("/dev/full", full);
    const auto run = simulate("four-bar:2 --duration 0.1 --trajectory '" + full + "'");
    EXPECT_EQ(run.status, 2);
    EXPECT_EQ(std::ranges::count(run.errors, '\n'), 1) << run.errors;
    EXPECT_NE(run.errors.find("cannot write '" + full + "': No space left"), std::string::npos)
        << run.errors;
    EXPECT_TRUE(fs::is_symlink(full));
    fs::remove(full);
  }
  EXPECT_EQ(simulate("four-bar:2 --duration 0.1 --trajectory '" + null + "'").status, 0);
  EXPECT_TRUE(fs::is_symlink(null));
  fs::remove(null);
  EXPECT_TRUE(folder.is_empty());
}

TEST_F(SimulateProgram, WritesWhereALinkLeadsThoughNothingIsThereYet) {
  const test::Folder folder;
  fs::create_symlink("target.csv", folder.file("link.csv"));
  EXPECT_EQ(
      simulate("four-bar:2 --duration 0.1 --trajectory '" + folder.file("link.csv") + "'").status,
      0);
  EXPECT_TRUE(fs::is_symlink(folder.file("link.csv")));
  EXPECT_TRUE(fs::is_regular_file(folder.file("target.csv")));
}

TEST_F(SimulateProgram, RefusesBadOptions) {
  for (const char* option : {"--step", "--duration", "--penalty", "--tolerance"}) {
    for (const char* value : {"0", "-1", "nan", "inf", "abc", "1e400", "0x10", "-0X1p4", "''"}) {
      expect_refusal(std::string("four-bar:2 ") + option + " " + value, option);
    }
  }
  for (const char* value : {"0", "-1", "1001", "abc", "1.5", "010", "+0x10"}) {
    expect_refusal(std::string("four-bar:2 --max-passes ") + value, "--max-passes");
  }
  for (const char* value : {"0", "-1", "abc"}) {
    expect_refusal(std::string("four-bar:2 --every ") + value, "--every");
  }
  expect_refusal("four-bar:2 --duration 1e300", "--duration");
  expect_refusal("four-bar:2 --duration 1e-9", "--duration");
  expect_refusal("four-bar:2 --step 1 --duration 0.9", "at least --step, 1 s");
  expect_refusal("four-bar:2 --no-such-option", "--no-such-option");
  expect_refusal("four-bar:2 four-bar:3", "four-bar:3");
  expect_refusal("four-bar:2 --step", "--step");
  expect_refusal("", "scene");
}

TEST_F(SimulateProgram, RefusesUnknownScenes) {
  for (const char* scene :
       {"four-bar:0", "four-bar:-1", "four-bar:99999999999", "four-bar:x",
        "four-bar:", "four-bar:2,fill=0", "four-bar:2,fill=1.5", "four-bar:2,fill=0.01",
        "four-bar:2,fill=nan", "no-such-scene", "no/such/scene.json"}) {
    expect_refusal(std::string("'") + scene + "'", scene);
  }
  expect_refusal("'" MBS_ROOT "'", "directory");
}

TEST_F(SimulateProgram, RefusesUnknownImplementations) {
  const std::string scene = "simulate four-bar:2 --implementation ";
  for (const std::string& name : {std::string("no_such"), std::string("no_such/variant"),
                                  all_variants().front().entry->folder + "/no_such"}) {
    expect_one_line(test::run_mbs(scene + name), name, "'" + name + "'");
  }
  expect_one_line(test::run_mbs("simulate four-bar:2"), "none", "--implementation");
  for (const char* name : {"missing", "missing/any"}) {
    expect_one_line(test::run_program(MBS_CONTROLS, scene + name), name,
                    "Missing is not installed: apt-get install libmissing-dev");
  }
  expect_one_line(test::run_program(MBS_CONTROLS, scene + "control"), "control", "variants");
}

TEST_F(SimulateProgram, RefusesScenesThatCannotBe) {
  const std::string head = R"({"points": [{"name": "A", "position": [0, 0], "fixed": true},
{"name": "B", "position": [1, 0]})";
  const std::string rod = R"({"between": ["A", "B"], "mass": 1})";
  const struct {
    std::string text, word;
  } cases[] = {
      {"{\"points\": [\n  oops]}", "line 2"},
      {"", "empty"},
      {head + R"(], "rods": [{"between": ["A", "B"], "mass": -1}]})", "rods[0].mass"},
      {head +
           R"(, {"name": "C", "position": [1, 0]}], "rods": [{"between": ["B", "C"], "mass": 1}, {"between": ["A", "B"], "mass": 1}]})",
       "rods[0]"},
      {head + R"(, {"name": "C", "position": [2, 0]}], "rods": [)" + rod + "]}", "points[2]"},
      {head +
           R"(, {"name": "C", "position": [2, 0], "fixed": true}, {"name": "D", "position": [1, 1],
"fixed": true}], "rods": [)" +
           rod + R"(, {"between": ["B", "C"], "mass": 1},
{"between": ["B", "D"], "mass": 1}]})",
       "over-fixed"},
      {head + R"(], "gravity": [0, 1e999], "rods": [)" + rod + "]}", "1e999"},
      {head + R"(], "gravity": [0, NaN], "rods": [)" + rod + "]}", "line 2"},
      {head + R"(], "rods": [)" + rod + R"(], "strings": []})", "strings"},
  };
  const test::Folder folder;
  for (const auto& [text, word] : cases) {
    std::ofstream(folder.file("scene.json")) << text;
    expect_refusal("'" + folder.file("scene.json") + "'", word);
  }
}

TEST_F(SimulateProgram, KnowsNoOtherSubcommands) {
  expect_one_line(test::run_mbs("frobnicate"), "frobnicate", "frobnicate");
  expect_one_line(test::run_mbs(""), "none", "subcommand");
}

TEST_F(SimulateProgram, RaisesASmallLimitOfTheStack) {
  if (MBS_SANITIZE) GTEST_SKIP() << "sanitizers need a stack before the program begins";
  const auto run = test::run_mbs(
      "simulate four-bar:100 --implementation eigen_dense/llt --duration 0.01", "ulimit -S -s 64;");
  EXPECT_EQ(run.status, 0) << run.errors;
}

}  // namespace
}  // namespace mbs
