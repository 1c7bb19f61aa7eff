// `mbs bench` from the outside: its JSON, its rows for failures, its errors.
#include <fcntl.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "registry/registry.hpp"
#include "support/folder.hpp"
#include "support/program.hpp"

namespace mbs {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr const char* kShort = " --steps 20 --benchmark_min_time=0 --benchmark_repetitions=1 ";

/// Runs `mbs bench` into a file and returns its JSON.
json bench(const std::string& arguments) {
  const std::string out = test::temporary_path("bench.json");
  const auto run =
      test::run_mbs(std::string("bench") + kShort + arguments + " '--benchmark_out=" + out + "'");
  EXPECT_EQ(run.status, 0) << run.errors;
  EXPECT_FALSE(fs::exists(out + ".partial"));
  const std::string text = test::file_text(out);
  fs::remove(out);
  return json::parse(text);
}

TEST(BenchProgram, WritesARowForEveryVariantAndScene) {
  const json result = bench("four-bar:1 four-bar:2 --phases");
  std::set<std::string> expected{"null/null/four-bar:1", "null/null/four-bar:2"}, names;
  for (const NamedVariant& variant : all_variants()) {
    if (variant.entry->implementation.role == Role::example) continue;
    expected.insert(variant.name + "/four-bar:1");
    expected.insert(variant.name + "/four-bar:2");
  }
  for (const json& row : result["benchmarks"]) {
    const std::string name = row["name"];
    SCOPED_TRACE(name);
    names.insert(name);
    EXPECT_EQ(row["run_name"], name);
    EXPECT_EQ(row["time_unit"], "us");
    ASSERT_FALSE(row.contains("error_occurred")) << row;
    EXPECT_EQ(row["steps"], 20);
    EXPECT_GE(row["passes"], 20);
    EXPECT_NEAR(row["step_us"], row["real_time"].get<double>() / 20, 1e-9 * 1e6);
    EXPECT_GT(row["setup_us"], 0.0);
    for (const char* key : {"steps_at_limit", "variables", "constraints", "fill_percent", "penalty",
                            "step", "tolerance", "max_passes", "start", "memory_bytes"}) {
      EXPECT_TRUE(row.at(key).is_number()) << key;
    }
    double shares = 0.0;
    for (const char* phase :
         {"evaluation", "assembly", "factorization", "solve", "projection", "other"}) {
      shares += row.at(std::string("phase_") + phase).get<double>();
    }
    EXPECT_NEAR(shares, 1.0, 1e-9);
    const bool control = name.starts_with("null/");
    for (const char* key : {"position_error", "constraint_violation", "energy_drift"}) {
      EXPECT_EQ(row.at(key).is_null(), control) << key;
    }
  }
  EXPECT_EQ(names, expected);
}

TEST(BenchProgram, AFileMayHaveAnyName) {
  const test::Folder folder;
  fs::copy_file(MBS_ROOT "/harness/scenes/pendulum.json", folder.file("\xff.json"));
  const json result = bench("'" + folder.file("\xff.json") + "' --implementation null");
  EXPECT_EQ(result["benchmarks"][0]["name"], "null/null/" + folder.file("\\xFF.json"));
}

TEST(BenchProgram, HasTheRecordInItsContext) {
  const json context =
      bench("four-bar:1 --implementation null --benchmark_context=round=3")["context"];
  for (const char* key :
       {"mbs_version", "commit", "dirty", "compiler", "flags", "build_type", "blas_loaded",
        "libraries", "cpu_model", "machine", "kernel", "threads_environment", "command", "date"}) {
    EXPECT_TRUE(context.at(key).is_string()) << key;
  }
  EXPECT_EQ(context["round"], "3");
  const std::string command = context["command"];
  EXPECT_TRUE(command.starts_with("mbs bench ")) << command;
  EXPECT_NE(command.find(" four-bar:1 --implementation null"), std::string::npos) << command;
}

TEST(BenchProgram, PrintsNoFigureThatIsNotThere) {
  const std::string scenes =
      "bench --implementation null --steps 2 --benchmark_min_time=0 '" MBS_ROOT
      "/harness/scenes/double_pendulum.json'";
  const auto run = test::run_mbs(scenes);
  EXPECT_EQ(run.status, 0) << run.errors;
  EXPECT_NE(run.output.find("step, µs"), std::string::npos) << run.output;
  EXPECT_EQ(run.output.find("nan"), std::string::npos) << run.output;
}

TEST(BenchProgram, AgreesWithItselfOnWhatItTimed) {
  if (all_variants().empty()) GTEST_SKIP() << "no implementation is available";
  const std::string name = all_variants().front().name;
  const json result = bench("four-bar:3 --implementation " + name + " --benchmark_repetitions=3");
  std::set<json> passes, errors;
  for (const json& row : result["benchmarks"]) {
    if (row["run_type"] != "iteration") continue;
    passes.insert(row["passes"]);
    errors.insert(row["position_error"]);
  }
  EXPECT_EQ(passes.size(), 1U);
  EXPECT_EQ(errors.size(), 1U);
}

TEST(BenchProgram, KeepsTheRowOfACellThatFails) {
  if (all_variants().empty()) GTEST_SKIP() << "no implementation is available";
  const std::string name = all_variants().front().name;
  const std::string only =
      " --implementation " + name + " --implementation null --start 0 --steps 700";
  // A penalty that constrains nothing: the rods fly apart, but the control runs.
  const std::string out = test::temporary_path("bench.json");
  const auto run = test::run_mbs(
      "bench four-bar:4 four-bar:1" + only +
      " --penalty 1e-3 --benchmark_min_time=0 --benchmark_repetitions=1 --benchmark_out=" + out);
  EXPECT_EQ(run.status, 1) << run.errors;
  const json result = json::parse(test::file_text(out));
  fs::remove(out);
  ASSERT_EQ(result["benchmarks"].size(), 4U);
  for (const json& row : result["benchmarks"]) {
    const bool control = row["name"].get<std::string>().starts_with("null/");
    EXPECT_EQ(row.contains("error_occurred"), !control) << row;
    if (!control) {
      EXPECT_TRUE(row["error_message"].get<std::string>().starts_with("diverged: ")) << row;
    }
  }
}

TEST(BenchProgram, PrintsRowsThatFailInEveryFormat) {
  for (const char* format : {"console", "csv", "json"}) {
    const auto run = test::run_mbs(
        "bench four-bar:4 four-bar:1 --start 0 --steps 700 --penalty 1e-3 --benchmark_min_time=0 "
        "--benchmark_filter='eigen_dense/.*four-bar:4|null/null/four-bar:1' --benchmark_format=" +
        std::string(format));
    EXPECT_EQ(run.status, 1) << format << ": " << run.errors;
    const bool table = format == std::string("console");  // where the scene is the heading
    EXPECT_NE(run.output.find(table ? "null/null" : "null/null/four-bar:1"), std::string::npos)
        << run.output;
    EXPECT_NE(run.output.find("diverged: "), std::string::npos) << run.output;
  }
}

TEST(BenchProgram, PrintsATableForEachScene) {
  const auto run = test::run_mbs(
      std::string("bench four-bar:1 four-bar:2 --phases --seed 4 --implementation eigen_dense") +
      kShort + "--benchmark_repetitions=7");
  EXPECT_EQ(run.status, 0) << run.errors;
  EXPECT_EQ(run.errors, "") << "progress is for terminals";
  for (const char* text : {"four-bar:1: 4 variables", "four-bar:2: 6 variables",
                           "7 samples of each", "factorization", " 1 ", "95 %"}) {
    EXPECT_NE(run.output.find(text), std::string::npos) << text << " in\n" << run.output;
  }
}

TEST(BenchProgram, RecordsHowTurnsWereTaken) {
  const json result = bench(
      "four-bar:1 --implementation null --seed 9223372036854775806 --benchmark_repetitions=3 "
      "--benchmark_min_time=0.0001");
  EXPECT_EQ(result["context"]["seed"], "9223372036854775806");
  EXPECT_EQ(result["context"]["slice_seconds"], "0.0001");
  ASSERT_EQ(result["benchmarks"].size(), 3U);
  for (int j = 0; j < 3; ++j) {
    const json& row = result["benchmarks"][static_cast<std::size_t>(j)];
    EXPECT_EQ(row["repetition_index"], j);
    EXPECT_EQ(row["repetitions"], 3);
    EXPECT_EQ(row["run_type"], "iteration");
    EXPECT_GT(row["iterations"], 1) << "twenty empty steps are shorter than a turn";
    EXPECT_GE(row["cpu_time"], 0.0);
  }
}

TEST(BenchProgram, LeavesTheSlowOut) {
  const std::string out = test::temporary_path("bench.json");
  const auto run = test::run_program(
      MBS_CONTROLS, "bench four-bar:2 --implementation control/reference --patience 1e-9" +
                        std::string(kShort) + "--benchmark_out=" + out);
  EXPECT_EQ(run.status, 0) << run.errors;
  const json row = json::parse(test::file_text(out)).at("benchmarks").at(0);
  fs::remove(out);
  EXPECT_EQ(row["error_occurred"], true);
  EXPECT_TRUE(row["error_message"].get<std::string>().starts_with("slower: did not finish")) << row;
}

/// What the program says on stderr when a control ends it, and how it ends.
void expect_ending(const std::string& control, const std::string& signal, int status,
                   const std::string& environment = "", const std::string& more = "") {
  const std::string command =
      "bench four-bar:2 --implementation control/reference --implementation control/" + control +
      kShort + more;
  auto run = test::run_program(MBS_CONTROLS, command, environment);
  if (run.errors.empty() && !environment.empty()) {
    // A program that the system has to read again may take seconds to start.
    run = test::run_program(MBS_CONTROLS, command, environment + "0");
  }
  EXPECT_EQ(run.status, status) << control;
  EXPECT_EQ(
      run.errors.find("mbs bench: ended by " + signal + " in control/" + control + "/four-bar:2\n"),
      0U)
      << run.errors;
}

TEST(BenchProgram, SaysWhoEndedIt) {
  if (MBS_SANITIZE) GTEST_SKIP() << "the sanitizers report these themselves";
  // The shell gives 128 and the signal.
  expect_ending("crashes", "SIGSEGV", 128 + SIGSEGV);
  expect_ending("aborts", "SIGABRT", 128 + SIGABRT);
  expect_ending("divides_by_zero", "SIGFPE", 128 + SIGFPE);
  expect_ending("overflows_stack", "SIGSEGV", 128 + SIGSEGV);
}

TEST(BenchProgram, SaysWhoWasRunningWhenItWasStopped) {
  const test::Folder folder;
  expect_ending("hangs", "SIGTERM", 124, "timeout 2", "--benchmark_out=" + folder.file("out.json"));
  EXPECT_TRUE(folder.is_empty()) << "half a file stays";
}

TEST(BenchProgram, TimesBatchesBesideTheirLanesAlone) {
  const json rows = bench("four-bar:1 four-bar:2 --batch --sets 11")["benchmarks"];
  std::size_t offering = 0;
  for (const NamedVariant& variant : all_variants()) {
    offering += variant.variant->create_batch != nullptr;
  }
  EXPECT_EQ(rows.size(), 2 * offering);
  for (const json& row : rows) {
    SCOPED_TRACE(row["name"]);
    EXPECT_TRUE(row["name"].get<std::string>().ends_with("/batch"));
    ASSERT_FALSE(row.contains("error_occurred")) << row;
    EXPECT_GT(row["lanes"], 1);
    EXPECT_EQ(row["steps"], 20);
    EXPECT_EQ(row["sets"], 11);  // a number that leaves a batch with fewer lanes
    EXPECT_NEAR(row["step_us"], row["real_time"].get<double>() / 20 / 11, 1e-6);
    EXPECT_NEAR(row["gain"], row["alone_us"].get<double>() / row["step_us"].get<double>(), 1e-6);
  }
}

TEST(BenchProgram, HelpShowsBothKindsOfOptions) {
  for (const char* flag : {"--help", "-h", "four-bar:2 --help"}) {
    const auto run = test::run_mbs(std::string("bench ") + flag);
    EXPECT_EQ(run.status, 0);
    for (const char* option :
         {"--implementation", "--penalty", "--phases", "--start", "--slower-than", "--patience",
          "--seed", "--summary", "--no-summary", "--benchmark_filter", "--benchmark_out"}) {
      EXPECT_NE(run.output.find(option), std::string::npos) << option;
    }
  }
}

TEST(BenchProgram, ListsNamesAsTheyAre) {
  const auto run = test::run_mbs(
      "bench four-bar:1 --benchmark_list_tests --benchmark_filter='^null/null/four-bar:1$'");
  EXPECT_EQ(run.status, 0);
  EXPECT_EQ(run.output, "null/null/four-bar:1\n");
}

/// One line, status 2, and the word that says what is wrong.
void expect_refusal(const std::string& arguments, const std::string& word) {
  const auto run = test::run_mbs("bench " + arguments);
  EXPECT_EQ(run.status, 2) << arguments;
  EXPECT_NE(run.errors.find(word), std::string::npos) << run.errors;
  EXPECT_TRUE(run.errors.starts_with("mbs: ") || arguments.find("abc") != std::string::npos)
      << run.errors;
  const auto lines = std::ranges::count(run.errors, '\n');
  EXPECT_LE(lines, arguments.find("abc") != std::string::npos ? 2 : 1) << run.errors;
  EXPECT_EQ(run.output, "");
}

TEST(BenchProgram, WhatIsUnsupportedIsARowAndNoFailure) {
  const auto run = test::run_mbs(
      "bench four-bar:1 --steps 5 --benchmark_min_time=0 --benchmark_repetitions=1 "
      "--scheme saddle-point "
      "--benchmark_format=json");
  EXPECT_EQ(run.status, 0) << run.errors;
  int unsupported = 0;
  const auto json = nlohmann::json::parse(run.output);
  for (const auto& row : json.at("benchmarks")) {
    if (row.value("error_occurred", false)) {
      EXPECT_EQ(row.at("error_message"),
                "unsupported: it does not offer --scheme saddle-point (mbs list tells who does)");
      ++unsupported;
    }
  }
  EXPECT_GT(unsupported, 0);
  EXPECT_LT(unsupported, static_cast<int>(json.at("benchmarks").size()) - 1);
}

TEST(BenchProgram, ASceneOnWhichNobodyIsTimedIsAFailure) {
  const std::string few = " --steps 2 --benchmark_min_time=0 --benchmark_repetitions=1",
                    joints = " '" MBS_ROOT "/harness/scenes/examples/spatial_joints.json' ";
  for (const char* words :
       {"--implementation compiled_chains/sweeps", "--implementation null,compiled_chains/sweeps",
        "--implementation csc_ldl/uplooking --batch"}) {
    SCOPED_TRACE(words);
    const auto run = test::run_mbs("bench four-bar:1" + joints + words + few);
    EXPECT_EQ(run.status, 1);
    EXPECT_NE(run.errors.find(": nothing was timed: "), std::string::npos) << run.errors;
  }
}

TEST(BenchProgram, RefusesBadInput) {
  expect_refusal("--benchmark_fliter=x", "--benchmark_fliter");
  expect_refusal("--benchmark_filter", "--benchmark_filter");
  expect_refusal("--no-such-option", "--no-such-option");
  expect_refusal("four-bar:1 --benchmark_filter=zzz", "selects none");
  expect_refusal("four-bar:1 '--benchmark_filter=('", "regular expression");
  expect_refusal("four-bar:1 --benchmark_min_time=abc", "--benchmark_min_time");
  expect_refusal("four-bar:1 --benchmark_min_time=-1", "--benchmark_min_time");
  expect_refusal("four-bar:1 --benchmark_repetitions=-1", "--benchmark_repetitions");
  expect_refusal("four-bar:1 --benchmark_format=xml", "--benchmark_format");
  expect_refusal("four-bar:1 --benchmark_out=x --benchmark_out_format=csv", "json");
  expect_refusal("four-bar:1 --benchmark_out=/no/such/folder/x.json", "/no/such/folder/x.json");
  expect_refusal("four-bar:1 --benchmark_out=/proc/version", "cannot write '/proc/version'");
  expect_refusal("four-bar:1 --benchmark_out=/usr", "cannot write '/usr'");
  expect_refusal("four-bar:1 --benchmark_out=", "--benchmark_out= names no file");
  expect_refusal("four-bar:1 --benchmark_out=-", "cannot write '-'");
  expect_refusal("four-bar:1 --slower-than 0.9", "--slower-than");
  expect_refusal("four-bar:1 --operations --tangent kept", "--tangent is one of steps");
  expect_refusal("four-bar:1 --slower-than nan", "--slower-than");
  expect_refusal("four-bar:1 --patience 0", "--patience");
  expect_refusal("four-bar:1 --patience -1", "--patience");
  expect_refusal("four-bar:1 --seed -1", "--seed");
  expect_refusal("four-bar:1 --seed 1.5", "--seed");
  expect_refusal("four-bar:1 --batch --seed 1", "--seed");
  expect_refusal("four-bar:1 --operations --patience 1", "--patience");
  expect_refusal("no-such-scene.json", "no-such-scene.json");
  expect_refusal("four-bar:1 --implementation no_such", "no_such");
  expect_refusal("four-bar:1 --step 0", "--step");
  expect_refusal("four-bar:1 --step nan", "--step");
  expect_refusal("four-bar:1 --steps 0", "--steps");
  expect_refusal("four-bar:1 --start -1", "--start");
  expect_refusal("four-bar:1 --penalty -1", "--penalty");
  expect_refusal("four-bar:1 --max-passes 0", "--max-passes");
  expect_refusal("four-bar:1 --batch --operations", "--batch");
  expect_refusal("four-bar:1 --batch --phases", "--batch");
  expect_refusal("four-bar:1 --operations --phases", "--operations");
  expect_refusal("four-bar:1 --operations --steps 3", "--steps");
  expect_refusal("four-bar:1 --operations --start 1", "--start");
  expect_refusal("four-bar:1 --seed 99999999999999999999", "--seed is");
  expect_refusal("--implementation null no-scene", "no-scene");
  expect_refusal("four-bar:1 --summary --no-summary", "--no-summary");
  expect_refusal("four-bar:1 --summary --benchmark_format=console", "--benchmark_format");
  expect_refusal("four-bar:1 --summary --benchmark_format=json", "--benchmark_format");
  expect_refusal("four-bar:1 --summary --batch", "--summary");
  expect_refusal("four-bar:1 --summary --operations", "--summary");
  expect_refusal("four-bar:1 --summary=maybe", "--summary");
  expect_refusal("four-bar:1 --sets 8", "--batch");
  expect_refusal("four-bar:1 --batch --sets 1", "--sets is 1");
}

TEST(BenchProgram, LeavesOlderResultsAloneWhenRefusing) {
  const std::string out = test::temporary_path("old.json");
  std::ofstream(out) << "precious";
  expect_refusal("four-bar:1 --benchmark_filter=zzz --benchmark_out=" + out, "selects none");
  EXPECT_EQ(test::file_text(out), "precious");
  fs::remove(out);
}

TEST(BenchProgram, DoesNotWaitForAPipe) {
  const std::string pipe = test::temporary_path("pipe");
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  expect_refusal("four-bar:1 --benchmark_out=" + pipe, "it is a pipe");
  fs::remove(pipe);
}

TEST(BenchProgram, WritesToWhatIsOpenAlready) {
  const std::string command = "bench four-bar:1 --implementation null --benchmark_out=/dev/stdout";
  for (const char* end : {"", " | grep benchmarks"}) {
    const auto run =
        test::run_program("sh", "-c \"'" MBS_PROGRAM "' " + command + kShort + end + "\"");
    EXPECT_EQ(run.status, 0) << run.errors;
    EXPECT_NE(run.output.find("benchmarks"), std::string::npos) << run.output;
    if (*end != '\0') continue;
    EXPECT_NE(run.output.find("\"context\""), std::string::npos)
        << run.output;  // none over the other
    EXPECT_NE(run.output.find(" variables, "), std::string::npos) << run.output;
  }
}

TEST(BenchProgram, WarnsOnceASceneAsSimulateDoes) {
  const auto run = test::run_mbs(std::string("bench four-bar:1 four-bar:2 --penalty 1 "
                                             "--implementation eigen_dense") +
                                 kShort);
  for (const char* scene : {"four-bar:1", "four-bar:2"}) {
    const std::string start = fmt::format("mbs: warning: {}: ", scene);
    const auto first = run.errors.find(start);
    ASSERT_NE(first, std::string::npos) << run.errors;
    EXPECT_EQ(run.errors.find(start, first + 1), std::string::npos) << run.errors;
  }
}

TEST(BenchProgram, SummaryNamesTheFastestOfEitherLayer) {
  const std::string out = test::temporary_path("bench.json");
  const auto run = test::run_mbs(
      "bench four-bar:1 four-bar:2 --summary --phases --implementation eigen_dense "
      "--implementation hybrid_dense/panels --steps 20 --benchmark_out=" +
      out);
  EXPECT_EQ(run.status, 0) << run.errors;
  EXPECT_EQ(run.errors, "");
  for (const char* text :
       {"four-bar:1: 4 variables", "four-bar:2: 6 variables", "fastest library:  eigen_dense/llt",
        "fastest own code: hybrid_dense/panels", "shares of the time, %", "95 %"}) {
    EXPECT_NE(run.output.find(text), std::string::npos) << text << " in\n" << run.output;
  }
  EXPECT_EQ(run.output.find("left out"), std::string::npos) << run.output;
  EXPECT_EQ(json::parse(test::file_text(out))["benchmarks"].size() % 2, 0U);
  fs::remove(out);
}

TEST(BenchProgram, SummaryTellsEqualReasonsOnce) {
  const auto run = test::run_mbs(
      "bench four-bar:1 --summary --steps 5 --benchmark_repetitions=1 --scheme saddle-point");
  EXPECT_EQ(run.status, 0) << run.errors;
  const std::string reason = "it does not offer --scheme saddle-point";
  const auto found = run.output.find(reason);
  ASSERT_NE(found, std::string::npos) << run.output;
  EXPECT_EQ(run.output.find(reason, found + 1), std::string::npos) << run.output;
  EXPECT_EQ(run.output.find("null/null"), std::string::npos) << run.output;
}

/// What `mbs bench` shows on a terminal; it must be short, for nobody reads while it is written.
std::string on_terminal(const std::string& arguments) {
  const int terminal = ::posix_openpt(O_RDWR | O_NOCTTY);
  EXPECT_GE(terminal, 0);
  EXPECT_EQ(::grantpt(terminal) + ::unlockpt(terminal), 0);
  const std::string name = ::ptsname(terminal);
  const int other = ::open(name.c_str(), O_RDWR | O_NOCTTY);  // keeps what was written
  const auto run = test::run_program(
      "sh", "-c \"'" MBS_PROGRAM "' bench four-bar:1 --implementation eigen_dense " +
                std::string(kShort) + arguments + " >" + name + "\"");
  EXPECT_EQ(run.status, 0) << run.errors;
  std::string text(1 << 16, '\0');
  ::fcntl(terminal, F_SETFL, O_NONBLOCK);
  std::size_t size = 0;
  for (ssize_t count = 1; count > 0;
       size += static_cast<std::size_t>(std::max(count, ssize_t{0}))) {
    count = ::read(terminal, text.data() + size, text.size() - size);
  }
  ::close(other);
  ::close(terminal);
  return text.substr(0, size);
}

TEST(BenchProgram, SummaryIsForTerminals) {
  const auto shows = [](const std::string& arguments, const char* what) {
    const std::string text = on_terminal(arguments);
    EXPECT_NE(text.find(what), std::string::npos) << arguments << " shows\n" << text;
  };
  const char* const summary = "fastest library:  eigen_dense/llt";
  const char* const table = "set-up, ";
  shows("", summary);
  shows("--benchmark_filter=eigen", summary);
  shows("--no-summary", table);
  shows("--benchmark_format=console", table);
  shows("--benchmark_out=/dev/null", table);
  const auto piped =
      test::run_mbs("bench four-bar:1 --implementation eigen_dense" + std::string(kShort));
  EXPECT_NE(piped.output.find(table), std::string::npos) << piped.output;
  EXPECT_EQ(piped.output.find(summary), std::string::npos) << piped.output;
}

TEST(BenchProgram, SaysSoWhenTheDiskIsFull) {
  const auto run = test::run_mbs(std::string("bench four-bar:1 --implementation null") + kShort +
                                 "--benchmark_out=/dev/full");
  EXPECT_EQ(run.status, 2);
  EXPECT_NE(run.errors.find("could not be written"), std::string::npos) << run.errors;
}

}  // namespace
}  // namespace mbs
