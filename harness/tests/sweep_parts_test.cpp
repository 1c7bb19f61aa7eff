// mbs sweep in jobs and parts, ended and gone on with: always the same table.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <thread>

#include "support/folder.hpp"
#include "support/program.hpp"
#include "sweep/journal.hpp"

namespace mbs {
namespace {

/// Lanes of three outcomes: some cannot be assembled, some are lost.
const std::string kLanes =
    "four-bar:1 --duration 0.1 --vary rods/A0-B0/length=1,3,1.1 --vary gravity/1=-12:-6:7 ";

class SweepParts : public ::testing::Test {
 protected:
  /// `before`: what the shell does first.
  test::ProgramResult sweep(const std::string& arguments, const std::string& output,
                            const std::string& variant = "batch/lost_lane",
                            const std::string& before = "") const {
    return test::run_program(MBS_CONTROLS, "sweep --implementation " + variant + " --output '" +
                                               at(output) + "' " + arguments, before);
  }
  [[nodiscard]] test::ProgramResult merge(const std::string& parts, const std::string& before = "") const {
    return test::run_program(MBS_CONTROLS, "merge-sweep " + parts + " --output out.csv",
                             "cd '" + folder_.file("") + "' && " + before);
  }
  /// The part `from` again, with one thing of its head as `value`.
  void change_head(const std::string& from, const std::string& to, const char* key, const nlohmann::json& value) const {
    const Journal part(at(from));
    nlohmann::json head = part.head();
    head[key] = value;
    Journal changed(at(to), head);
    for (long block = 0; block < head.at("blocks").get<long>(); ++block) {
      if (part.has(block)) changed.add(block, part.read(block));
    }
  }
  void expect_refusal(const test::ProgramResult& run, const std::vector<std::string>& words) const {
    EXPECT_EQ(run.status, 2);
    EXPECT_EQ(std::ranges::count(run.errors, '\n'), 1) << run.errors;
    for (const std::string& word : words) {
      EXPECT_NE(run.errors.find(word), std::string::npos) << word << " is not in " << run.errors;
    }
    EXPECT_FALSE(std::filesystem::exists(at("out.csv")));
  }
  [[nodiscard]] std::string at(const std::string& name) const { return folder_.file(name); }
  [[nodiscard]] std::string text(const std::string& name) const { return test::file_text(at(name)); }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(at(name), std::ios::binary) << text;
  }
  [[nodiscard]] std::size_t files() const {
    return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder_.file("")), {}));
  }

  test::Folder folder_;
};

TEST_F(SweepParts, AreWhatOneProcessWrites) {
  const auto whole = sweep(kLanes, "whole.csv");
  EXPECT_EQ(whole.status, 1) << whole.errors;
  const auto jobs = sweep(kLanes + "--jobs 3", "jobs.csv");
  EXPECT_EQ(jobs.errors, whole.errors);
  EXPECT_EQ(text("jobs.csv"), text("whole.csv"));
  for (const char* part : {"1", "2", "3"}) sweep(kLanes + "--shard " + part + "/3", part);
  const auto merged = merge("3 1 2");
  EXPECT_EQ(merged.errors, whole.errors);
  EXPECT_EQ(merged.status, 1);
  EXPECT_EQ(text("out.csv"), text("whole.csv"));
  EXPECT_EQ(files(), 6U);  // three tables, three parts, nothing else
}

TEST_F(SweepParts, CompressedIsTheSameTable) {
  sweep(kLanes, "whole.csv");
  sweep(kLanes, "whole.csv.gz");
  const std::string unpacked = test::run_program("zcat", "'" + at("whole.csv.gz") + "'").output;
  EXPECT_EQ(unpacked, text("whole.csv"));
  EXPECT_LT(text("whole.csv.gz").size(), unpacked.size() / 2);
}

TEST_F(SweepParts, GoOnAfterAKill) {
  const std::string lanes = "four-bar:2 --duration 0.5 --vary gravity/1=-12:-6:120";
  ASSERT_EQ(sweep(lanes, "whole.csv", "batch/sound").status, 0);
  const std::string table = at("t.csv"), journal = table + ".journal";
  const pid_t child = ::fork();
  if (child == 0) {
    ::execl(MBS_CONTROLS, MBS_CONTROLS, "sweep", "four-bar:2", "--duration", "0.5", "--vary",
            "gravity/1=-12:-6:120", "--implementation", "batch/sound", "--jobs", "2", "--output",
            table.c_str(), nullptr);
    ::_exit(127);
  }
  const auto size = [&] {
    std::error_code none;
    const auto bytes = std::filesystem::file_size(journal, none);
    return none ? 0 : bytes;
  };
  while (size() < 3000 && ::waitpid(child, nullptr, WNOHANG) == 0) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  ::kill(child, SIGKILL);
  ::waitpid(child, nullptr, 0);
  ASSERT_FALSE(std::filesystem::exists(table)) << "it was too quick to be killed";
  EXPECT_EQ(files(), 2U);  // the other table and the journal
  const std::string before = test::file_text(journal);
  EXPECT_EQ(sweep(lanes, "t.csv", "batch/sound").status, 2);  // without --resume
  EXPECT_EQ(test::file_text(journal), before);
  write("t.csv.4711-0.partial", "as a kill leaves it that comes when the table is written");
  write("t.csv.gz.4711-0.partial", "of another table");
  const auto run = sweep(lanes + " --jobs 2 --resume", "t.csv", "batch/sound");
  EXPECT_EQ(run.output, "120 lanes: 120 plausible\n") << run.errors;
  EXPECT_EQ(text("t.csv"), text("whole.csv"));
  EXPECT_EQ(text("t.csv.gz.4711-0.partial"), "of another table");
  EXPECT_EQ(files(), 3U);
}

TEST_F(SweepParts, AJournalWithoutABlockIsNothingToGoOnWith) {
  sweep(kLanes, "whole.csv");
  { const Journal begun(at("t.csv.journal"), {{"sweep", "ended while it looked at its lanes"}}); }
  EXPECT_EQ(sweep(kLanes, "t.csv").status, 1);
  EXPECT_EQ(text("t.csv"), text("whole.csv"));
  const auto refused = sweep("four-bar:1 --jobs 2 --vary rods/A0-B0/mass=1:-1:20", "bad.csv");
  EXPECT_EQ(refused.status, 2);
  EXPECT_NE(refused.errors.find("lane 11 of 20"), std::string::npos) << refused.errors;
  EXPECT_EQ(files(), 2U);  // nothing of the last
}

TEST_F(SweepParts, AFinishedTableIsNotMadeAgainByResume) {
  sweep(kLanes, "t.csv");
  const std::string before = text("t.csv");
  const auto again = sweep(kLanes + "--resume", "t.csv");
  EXPECT_EQ(again.status, 2);
  EXPECT_NE(again.errors.find("without --resume"), std::string::npos) << again.errors;
  EXPECT_EQ(text("t.csv"), before);
}

TEST_F(SweepParts, AFullDiskAtTheStartLeavesNothing) {
  const auto full = sweep(kLanes, "t.csv", "batch/lost_lane", "ulimit -f 1;");  // not even the head of the journal
  EXPECT_EQ(full.status, 2);
  EXPECT_NE(full.errors.find("t.csv.journal: "), std::string::npos) << full.errors;
  EXPECT_EQ(files(), 0U);
  write("t.csv.journal", "");  // as a kill may leave it
  EXPECT_EQ(sweep(kLanes + "--resume", "t.csv").status, 1);
  sweep(kLanes, "whole.csv");
  EXPECT_EQ(text("t.csv"), text("whole.csv"));
}

TEST_F(SweepParts, AFileMayHaveAnyName) {
  for (const char* name : {"\xff.json", "\xed\xa0\x80.json", "\xf4\x90\x80\x80.json"}) {
    const std::string scene = at(name);
    std::filesystem::copy_file(MBS_ROOT "/harness/scenes/double_pendulum.json", scene);
    const auto run = sweep("'" + scene + "' --duration 0.1 --vary gravity/1=-9,-8", "t.csv", "batch/sound");
    EXPECT_EQ(run.status, 0) << run.errors;
  }
}

TEST_F(SweepParts, MayBeInMemory) {
  const std::filesystem::path memory = "/dev/shm";
  std::error_code error;
  if (::access(memory.c_str(), W_OK) != 0) GTEST_SKIP() << "there is no /dev/shm";
  const std::filesystem::path part = memory / std::filesystem::path(at("part")).parent_path().filename();
  const auto run = test::run_program(MBS_CONTROLS, "sweep --implementation batch/sound --shard 1/2 --output '" +
                                                       part.string() + "' " + kLanes);
  EXPECT_EQ(run.status, 1) << run.errors;  // for the lanes that cannot be assembled
  EXPECT_TRUE(std::filesystem::remove(part, error));
}

TEST_F(SweepParts, NeedNoMoreFilesThanAreAllowed) {
  const std::string few = "prlimit --nofile=12: ";  // the soft limit; sh itself needs more
  EXPECT_EQ(sweep(kLanes + "--jobs 12", "whole.csv", "batch/sound", few).status, 1);
  std::string parts;
  for (int part = 1; part <= 12; ++part) {
    const std::string name = std::to_string(part);
    sweep(kLanes + "--shard " + name + "/12", name, "batch/sound");
    parts += name + " ";
  }
  const auto merged = merge(parts, few);
  EXPECT_EQ(merged.status, 1) << merged.errors;
  EXPECT_EQ(text("out.csv"), text("whole.csv"));
}

TEST_F(SweepParts, AMergeThatWasKilledLeavesNothingToTheNext) {
  sweep(kLanes + "--shard 1/1", "1");
  write("out.csv.4711-0.partial", "half of a table");
  EXPECT_EQ(merge("1").status, 1);
  EXPECT_EQ(files(), 2U);
}

TEST_F(SweepParts, AFinishedPartIsNotDoneAgain) {
  sweep(kLanes + "--shard 1/2", "1");
  const auto before = std::filesystem::last_write_time(at("1"));
  const auto again = sweep(kLanes + "--shard 1/2", "1");
  EXPECT_EQ(again.status, 2);
  EXPECT_NE(again.errors.find("--resume"), std::string::npos) << again.errors;
  EXPECT_EQ(sweep(kLanes + "--shard 1/2 --resume", "1").status, 1);
  EXPECT_EQ(std::filesystem::last_write_time(at("1")), before);
  EXPECT_EQ(sweep(kLanes + "--shard 2/2 --resume", "1").status, 2);  // another part
}

TEST_F(SweepParts, APartThatWasCutOrDamagedIsMendedByItsCommand) {
  const std::string command = kLanes + "--shard 1/2 ";
  sweep(kLanes, "whole.csv");
  for (const char* part : {"1", "2"}) sweep(kLanes + "--shard " + part + "/2", part);
  const std::string part = text("1");
  std::string flipped = part, larger = part;
  flipped[flipped.find("plausible")] = 'P';  // in its first block
  larger.insert(larger.find("block 2 ") + 8, "9");
  const struct {
    std::string text;
    bool is_damaged;
  } cases[] = {{part.substr(0, part.size() - 10), false},
               {part.substr(0, part.find("block 2 ")), false},
               {"", false},
               {flipped, true},
               {larger, true}};
  for (const auto& [changed, is_damaged] : cases) {
    write("1", changed);
    EXPECT_EQ(merge("1 2").status, 2);
    EXPECT_EQ(sweep(command, "1").status, 2);  // without --resume
    EXPECT_EQ(text("1"), changed);
    const auto mended = sweep(command + "--resume --jobs 2", "1");
    EXPECT_EQ(mended.status, 1) << mended.errors;  // for the lanes that cannot be assembled
    EXPECT_EQ(mended.errors.find("note: ") != std::string::npos, is_damaged) << mended.errors;
    EXPECT_EQ(mended.errors.find("2 of 3 blocks are there") != std::string::npos, is_damaged);
    EXPECT_EQ(sweep(command + "--resume", "1").errors.find("note: "), std::string::npos);
    EXPECT_EQ(merge("1 2").status, 1);
    EXPECT_EQ(text("out.csv"), text("whole.csv"));
    std::filesystem::remove(at("out.csv"));
  }
  EXPECT_EQ(files(), 3U);
}

TEST_F(SweepParts, AJobThatEndsIsSaid) {
  if (MBS_SANITIZE) GTEST_SKIP() << "the sanitizers report the crash themselves, at length";
  const auto run = sweep("four-bar:1 --vary gravity/1=-12:-6:4 --jobs 2", "t.csv", "control/crashes");
  EXPECT_EQ(run.status, 2);
  EXPECT_EQ(std::ranges::count(run.errors, '\n'), 1) << run.errors;
  EXPECT_NE(run.errors.find("--resume"), std::string::npos) << run.errors;
  EXPECT_FALSE(std::filesystem::exists(at("t.csv")));
}

TEST_F(SweepParts, RefuseWhatDoesNotBelongTogether) {
  for (const char* part : {"1", "2"}) sweep(kLanes + "--shard " + part + "/2", part);
  expect_refusal(merge("1"), {"part 2 of 2 is missing"});
  expect_refusal(merge("1 2 1"), {"part 1 of 2 is given twice"});
  expect_refusal(merge("1 nowhere"), {"nowhere"});
  const std::string second = text("2");
  std::string changed = second;
  changed.replace(changed.find("plausible"), 9, "plausiblE");
  write("changed", changed);
  expect_refusal(merge("1 changed"),
                 {"changed: this part is damaged or was changed (block ", "--resume"});
  changed = second;
  changed.replace(changed.find("\"lanes\":21"), 10, "\"lanes\":22");
  write("changed", changed);
  expect_refusal(merge("1 changed"), {"its head is damaged"});
  write("cut", second.substr(0, second.size() - 10));
  expect_refusal(merge("1 cut"),
                 {"cut: this part is not finished (block 5 of 6 is missing)", "--resume"});
  write("empty", "");
  expect_refusal(merge("1 empty"), {"empty: it is no part of a sweep"});
  sweep(kLanes + "--step 1e-3 --shard 2/2", "other");
  expect_refusal(merge("1 other"), {"other: found another sweep (not the same: options)"});
  sweep(kLanes + "--shard 2/3", "third");
  expect_refusal(merge("1 third"), {"third: it is one of 3 parts"});
  expect_refusal(test::run_program(MBS_CONTROLS, "sweep --implementation batch/sound --output '" +
                                                     at("out.csv") + "' --shard 3/2 " + kLanes),
                 {"--shard", "i from 1 to K"});
}

TEST_F(SweepParts, AnotherBuildIsRefused) {
  sweep(kLanes + "--shard 1/2", "1");
  const std::string copy = at("mbs");
  std::filesystem::copy_file(MBS_CONTROLS, copy);
  std::ofstream(copy, std::ios::app) << "another";
  test::run_program(copy, "sweep --implementation batch/lost_lane --shard 2/2 --output '" + at("2") + "' " + kLanes);
  expect_refusal(merge("1 2"), {"2: found another build of mbs"});
}

TEST_F(SweepParts, AnotherProcessorOrLibraryIsRefused) {
  for (const char* part : {"1", "2"}) sweep(kLanes + "--shard " + part + "/2", part);
  change_head("2", "elsewhere", "processor", "another");
  expect_refusal(merge("1 elsewhere"), {"elsewhere: found another processor"});
  change_head("2", "other", "libraries", "others");
  expect_refusal(merge("1 other"), {"other: found other libraries"});
  change_head("2", "third", "shard", {3, 2});
  expect_refusal(merge("1 third"), {"third: found part 3 of 2"});
  change_head("2", "none", "shard", {0, 2});
  expect_refusal(merge("1 none"), {"none: found part 0 of 2"});
}

TEST_F(SweepParts, SamplesComeBesideGrids) {
  const std::string lanes =
      "four-bar:1 --duration 0.1 --vary gravity/1=-9,-8 --vary rods/A0-B0/mass=uniform:1:2 --sample 3 ";
  ASSERT_EQ(sweep(lanes + "--seed 5", "a.csv", "batch/sound").status, 0);
  sweep(lanes + "--seed 5 --jobs 2", "b.csv", "batch/sound");
  sweep(lanes + "--seed 6", "c.csv", "batch/sound");
  sweep(lanes + "--seed 5 --sobol", "d.csv", "batch/sound");
  EXPECT_EQ(text("a.csv"), text("b.csv"));
  EXPECT_NE(text("a.csv"), text("c.csv"));
  EXPECT_NE(text("a.csv"), text("d.csv"));
  expect_refusal(sweep("four-bar:1 --vary gravity/1=-9 --sample 3", "out.csv"), {"--sample", "uniform:a:b"});
  expect_refusal(sweep("four-bar:1 --vary gravity/1=normal:1:2", "out.csv"), {"--sample N"});
  expect_refusal(sweep("four-bar:1 --vary gravity/1=-9 --sobol", "out.csv"), {"--sobol", "--sample"});
  expect_refusal(sweep("four-bar:1 --vary gravity/1=-9 --seed 2", "out.csv"), {"--seed", "--sample"});
  expect_refusal(sweep("four-bar:1 --vary gravity/1=uniform:2:1 --sample 3", "out.csv"), {"a below b"});
  expect_refusal(sweep("four-bar:1 --vary gravity/1=normal:2:0 --sample 3", "out.csv"), {"above 0"});
}

}  // namespace
}  // namespace mbs
