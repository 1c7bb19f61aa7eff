// A sweep's journal: what is in it after each way to end.
#include <gtest/gtest.h>

#include <fstream>

#include "support/folder.hpp"
#include "sweep/journal.hpp"
#include "usage_error.hpp"

namespace mbs {
namespace {

const nlohmann::json kHead{{"sweep", "of a test"}};

TEST(SweepJournal, HasWhatWasAdded) {
  const test::Folder folder;
  const std::string path = folder.file("j");
  {
    Journal journal(path, kHead);
    journal.add(7, "seven\nlines");
    journal.add(2, "");
    journal.scan();
    EXPECT_EQ(journal.read(7), "seven\nlines");
    EXPECT_THROW(static_cast<void>(journal.read(3)), UsageError);
  }
  const Journal journal(path);
  EXPECT_EQ(journal.head(), kHead);
  EXPECT_EQ(journal.size(), 2U);
  EXPECT_FALSE(journal.damage());
  EXPECT_EQ(journal.read(7), "seven\nlines");
  EXPECT_EQ(journal.read(2), "");
  EXPECT_FALSE(journal.has(1));
}

/// The text of a journal of two blocks, left at `path`.
std::string two_blocks(const std::string& path) {
  {
    Journal journal(path, kHead);
    journal.add(0, "first");
    journal.add(1, "second");
  }
  return test::file_text(path);
}

TEST(SweepJournal, LosesNoMoreThanTheBlockThatWasCut) {
  const test::Folder folder;
  const std::string path = folder.file("j");
  const std::string whole = two_blocks(path);
  const std::size_t first = whole.find("block 1");
  for (std::size_t length = first; length < whole.size(); ++length) {
    std::ofstream(path, std::ios::binary) << whole.substr(0, length);
    EXPECT_FALSE(Journal(path).damage()) << length;
    Journal journal(path, kHead);
    EXPECT_TRUE(journal.has(0)) << length;
    EXPECT_FALSE(journal.has(1)) << length;
    journal.add(1, "second");
    EXPECT_EQ(test::file_text(path), whole) << length;
  }
}

TEST(SweepJournal, LosesNoMoreThanALastBlockThatIsDamaged) {
  const test::Folder folder;
  const std::string path = folder.file("j");
  const std::string whole = two_blocks(path);
  std::string changed = whole;
  changed.back() = '\0';
  std::ofstream(path, std::ios::binary) << changed;
  EXPECT_EQ(Journal(path).damage(), whole.find("block 1"));
  {
    Journal journal(path, kHead);
    EXPECT_TRUE(journal.has(0) && !journal.has(1) && journal.damage());
    journal.add(1, "second");
  }
  EXPECT_EQ(test::file_text(path), whole);  // the damaged one was dropped
}

/// Three blocks of lines.
std::string three_blocks(const std::string& path) {
  {
    Journal journal(path, kHead);
    for (const long block : {4, 0, 2}) {
      journal.add(block, "{}\n" + std::to_string(block) + ",plausible\n0,\"a\nb\"\n");
    }
  }
  return test::file_text(path);
}

/// Whatever is changed, cut out or put in before it: a block is found, and the others can be added.
TEST(SweepJournal, LosesOnlyTheBlocksThatAreDamaged) {
  const test::Folder folder;
  const std::string path = folder.file("j");
  const std::string whole = three_blocks(path);
  const std::size_t first = whole.find("block 4"), second = whole.find("block 0");
  const auto expect_mended = [&](const std::string& changed, std::size_t damage) {
    std::ofstream(path, std::ios::binary) << changed;
    {
      Journal journal(path, kHead);
      ASSERT_TRUE(journal.has(2)) << changed;
      EXPECT_EQ(journal.damage(), damage) << changed;
      EXPECT_LT(journal.size(), 3U) << changed;
      for (const long block : {0, 4}) {
        if (!journal.has(block)) journal.add(block, "again");
      }
    }
    const Journal mended(path);
    EXPECT_EQ(mended.size(), 3U) << changed;
    EXPECT_EQ(mended.read(2), "{}\n2,plausible\n0,\"a\nb\"\n") << changed;
  };
  for (std::size_t i = first; i < second; ++i) {
    std::string changed = whole;
    changed[i] = static_cast<char>(changed[i] ^ 1);
    expect_mended(changed, first);
    expect_mended(whole.substr(0, i) + whole.substr(i + 1), first);
    expect_mended(whole.substr(0, i) + whole.substr(second + 8), first);  // within the next header
  }
  std::string larger = whole;
  expect_mended(larger.insert(first + std::string("block 4 ").size(), "9"), first);
  larger = whole;
  expect_mended(larger.insert(second + std::string("block 0 ").size(), "9"), second);
}

/// The damage stays in the file, behind which its block is.
TEST(SweepJournal, HasWhatWasMended) {
  const test::Folder folder;
  const std::string path = folder.file("j");
  std::string changed = two_blocks(path);
  changed[changed.find("first")] = '\0';
  std::ofstream(path, std::ios::binary) << changed;
  {
    Journal journal(path, kHead);
    EXPECT_TRUE(!journal.has(0) && journal.has(1));
    journal.add(0, "first");
    journal.scan();
    EXPECT_EQ(journal.read(0), "first");
  }
  EXPECT_EQ(Journal(path).read(0), "first");
  EXPECT_EQ(Journal(path, kHead).read(1), "second");
}

TEST(SweepJournal, BeginsWhereNoHeadWasWritten) {
  const test::Folder folder;
  const std::string path = folder.file("j");
  const std::string whole = two_blocks(path);
  for (std::size_t length = 0; length <= whole.find('\n'); ++length) {
    std::ofstream(path, std::ios::binary) << whole.substr(0, length);
    EXPECT_THROW(Journal{path}, UsageError) << length;
    EXPECT_EQ(two_blocks(path), whole) << length;
  }
}

TEST(SweepJournal, LeavesWhatItCannotUse) {
  const test::Folder folder;
  const std::string path = folder.file("j");
  EXPECT_ANY_THROW(Journal(path, {{"sweep", "\xff"}}));  // no text of JSON
  EXPECT_TRUE(folder.is_empty());
  for (const char* text : {"mine", "mine\n", "mbs-swap"}) {
    std::ofstream(path, std::ios::binary) << text;
    EXPECT_THROW(Journal(path, kHead), UsageError);
    EXPECT_EQ(test::file_text(path), text);
  }
}

TEST(SweepJournal, SeesAnyChange) {
  const test::Folder folder;
  const std::string path = folder.file("j");
  const std::string whole = two_blocks(path);
  for (std::size_t i = 0; i < whole.size(); ++i) {
    std::string changed = whole;
    changed[i] = static_cast<char>(changed[i] ^ 1);
    std::ofstream(path, std::ios::binary) << changed;
    try {
      const Journal journal(path);
      EXPECT_FALSE(journal.has(0) && journal.has(1)) << i;
    } catch (const UsageError&) {
    }
  }
}

TEST(SweepJournal, HasOneWriter) {
  const test::Folder folder;
  const std::string path = folder.file("j");
  {
    Journal journal(path, kHead);
    journal.add(0, "first");
    EXPECT_THROW(Journal(path, kHead), UsageError);
    EXPECT_EQ(Journal(path).size(), 1U);
  }
  EXPECT_EQ(Journal(path, kHead).size(), 1U);
}

}  // namespace
}  // namespace mbs
