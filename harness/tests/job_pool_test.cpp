// Blocks in processes: each is kept once, and the first fault is told.
#include "sweep/job_pool.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>
#include <new>
#include <numeric>
#include <vector>

#include "support/folder.hpp"
#include "sweep/journal.hpp"
#include "usage_error.hpp"

namespace mbs {
namespace {

std::vector<long> blocks_to(long count) {
  std::vector<long> blocks(static_cast<std::size_t>(count));
  std::iota(blocks.begin(), blocks.end(), 0);
  return blocks;
}

std::string text_of_block(long block) { return std::string(static_cast<std::size_t>(block * 37 % 5000), char('a' + block % 26)); }

TEST(JobPool, KeepsEachBlockOnce) {
  const test::Folder folder;
  for (const int jobs : {1, 4}) {
    Journal journal(folder.file(std::to_string(jobs)), {{"sweep", "of a test"}});
    std::size_t kept = 0;
    for_blocks(
        jobs, blocks_to(400), text_of_block,
        [&](long block, const std::string& text) { journal.add(block, text); },
        [&](std::size_t, std::size_t done) { kept = done; });
    EXPECT_EQ(kept, 400U);
    journal.scan();
    EXPECT_FALSE(journal.damage());
    ASSERT_EQ(journal.size(), 400U);
    for (long block = 0; block < 400; ++block) EXPECT_EQ(journal.read(block), text_of_block(block));
  }
}

void run_pool(int jobs, const std::function<void(long)>& work) {
  const auto worked = [&](long block) {
    work(block);
    return std::string();
  };
  for_blocks(
      jobs, blocks_to(40), worked, [](long, const std::string&) {},
      [](std::size_t, std::size_t) {});
}

std::string fault_of_pool(int jobs, const std::function<void(long)>& work) {
  try {
    run_pool(jobs, work);
  } catch (const UsageError& error) {
    return error.what();
  }
  return "none";
}

TEST(JobPool, PreparesAllBeforeItWorks) {
  for (const int jobs : {1, 4}) {
    const test::Folder folder, prepared;
    Journal journal(folder.file("j"), {{"sweep", "of a test"}});
    const auto count = [&] {
      const auto files = std::filesystem::directory_iterator(prepared.file(""));
      return std::to_string(std::distance(files, {}));
    };
    const auto touch = [&](long block) { std::ofstream(prepared.file(std::to_string(block))); };
    for_blocks(
        jobs, blocks_to(40), [&](long) { return count(); },
        [&](long block, const std::string& text) { journal.add(block, text); },
        [](std::size_t, std::size_t) {}, touch);
    journal.scan();
    ASSERT_EQ(journal.size(), 40U);
    for (long block = 0; block < 40; ++block) EXPECT_EQ(journal.read(block), "40");
  }
}

TEST(JobPool, WorksOnNothingWhereOneCannotBePrepared) {
  for (const int jobs : {1, 3}) {
    const test::Folder folder;
    const auto touch = [&](long block) {
      std::ofstream(folder.file(std::to_string(block)));
      return std::string();
    };
    const auto refuse = [](long block) {
      if (block == 5) ::usleep(100'000);  // those behind it fail before
      if (block >= 5) throw UsageError("block " + std::to_string(block));
    };
    try {
      for_blocks(
          jobs, blocks_to(40), touch, [](long, const std::string&) {},
          [](std::size_t, std::size_t) {}, refuse);
      ADD_FAILURE() << "nothing was refused";
    } catch (const UsageError& error) {
      EXPECT_STREQ(error.what(), "block 5");
    }
    EXPECT_TRUE(folder.is_empty());
  }
}

TEST(JobPool, TellsTheFirstFault) {
  for (const int jobs : {1, 3}) {
    EXPECT_EQ(fault_of_pool(jobs,
                       [](long block) {
                         if (block == 5) ::usleep(100'000);  // those behind it fail before
                         if (block >= 5) throw UsageError("block " + std::to_string(block));
                       }),
              "block 5");
    EXPECT_THROW(run_pool(jobs, [](long block) { if (block == 3) throw std::bad_alloc(); }), std::bad_alloc);
    EXPECT_THROW(run_pool(jobs, [](long block) { if (block == 3) throw std::logic_error("of a test"); }), std::exception);
  }
}

TEST(JobPool, EndsWhereAProcessIsLost) {
  EXPECT_NE(fault_of_pool(2, [](long block) { if (block == 7) ::raise(SIGKILL); }).find("ended in block 7 (Killed)"), std::string::npos);
  EXPECT_NE(fault_of_pool(2, [](long block) { if (block == 7) ::_exit(0); }).find("ended in block 7 (exit)"), std::string::npos);
}

TEST(JobPool, IgnoresWhatTheProgramIgnores) {
  const auto before = std::signal(SIGHUP, SIG_IGN);  // nohup
  EXPECT_EQ(fault_of_pool(2, [](long block) { if (block == 7) ::raise(SIGHUP); }), "none");
  std::signal(SIGHUP, before);
}

}  // namespace
}  // namespace mbs
