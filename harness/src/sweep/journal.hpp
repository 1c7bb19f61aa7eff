// What a sweep has done so far, block by block, so that it can go on after any end.
#pragma once

#include <cstdio>
#include <fstream>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

namespace mbs {

/// A file of a head, which says what sweep it is of, and of blocks in any order, each with
/// checksums. A block that is damaged, was changed or was not written to its end is not there;
/// whatever is, is found. It may then be added again.
class Journal {
 public:
  /// To read. Throws UsageError if it cannot be, is no journal, has a damaged head or a block
  /// twice.
  explicit Journal(const std::string& path);
  /// To write, which no other program does meanwhile: behind the last block that is there, whatever
  /// the head; a new one with `head` where none was written to its end. Throws UsageError; then no
  /// file is left that was not there.
  Journal(const std::string& path, const nlohmann::json& head);

  [[nodiscard]] const std::string& path() const { return path_; }
  [[nodiscard]] const nlohmann::json& head() const { return head_; }
  [[nodiscard]] bool has(long block) const { return blocks_.contains(block); }
  [[nodiscard]] std::size_t size() const { return blocks_.size(); }
  /// Where something is damaged or was changed first, byte; nothing: nowhere. A last block that was
  /// not written to its end is no damage.
  [[nodiscard]] std::optional<std::size_t> damage() const { return damage_; }
  /// Written when this returns, or not at all: throws UsageError on a full disk. Copies of this process
  /// may add as well, one at a time; scan() then finds what is there.
  void add(long block, const std::string& text);
  void scan();
  [[nodiscard]] std::string read(long block) const;

 private:
  struct Record {
    std::size_t offset = 0, size = 0;
  };
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  [[noreturn]] void fail(const std::string& what) const;
  bool read_head();
  void begin(const std::string& line);
  bool end_at(std::size_t size);
  [[nodiscard]] std::optional<std::string> read_at(std::size_t offset, std::size_t size) const;

  std::string path_;
  nlohmann::json head_;
  std::map<long, Record> blocks_;
  std::size_t end_ = 0;  // of the last block
  std::optional<std::size_t> damage_;
  mutable std::ifstream input_;
  std::unique_ptr<std::FILE, Close> file_;  // to write to, locked; null: only read
};

inline constexpr std::size_t kLongestPath = 4096;  ///< bytes of one that a message shows

/// zlib's CRC-32, as eight digits.
std::string checksum(const std::string& text);
/// Of the program that runs.
std::string program_checksum();

}  // namespace mbs
