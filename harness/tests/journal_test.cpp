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
  EXPECT_TRUE(journal.is_whole());
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
    EXPECT_EQ(Journal(path).is_whole(), length == first);
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
  EXPECT_THROW(Journal{path}, UsageError);  // who only reads cannot do it again
  {
    Journal journal(path, kHead);
    EXPECT_TRUE(journal.has(0) && !journal.has(1));
    journal.add(1, "second");
  }
  EXPECT_EQ(test::file_text(path), whole);
  changed = whole;
  changed[whole.find("first")] = '\0';
  std::ofstream(path, std::ios::binary) << changed;
  EXPECT_THROW(Journal(path, kHead), UsageError);
  EXPECT_EQ(test::file_text(path), changed);
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
      const Journal journal(path);  // a longer size looks like a block that was cut
      EXPECT_FALSE(journal.is_whole() && journal.size() == 2 && journal.has(0) && journal.has(1)) << i;
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
