// Lines that begin a block: "block NUMBER SIZE CHECKSUM", then so many bytes.
#include "sweep/journal.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>
#include <zlib.h>

#include <cerrno>
#include <cstring>
#include <sstream>

#include "printable.hpp"
#include "usage_error.hpp"

namespace mbs {
namespace {

constexpr const char* kBegin = "mbs-sweep";
constexpr std::size_t kLargestBlock = std::size_t{1} << 30;

std::string digits(uLong crc) { return fmt::format("{:08x}", crc); }

std::string checksum_of_block(long block, const std::string& text) {
  return checksum(fmt::format("{}\n{}", block, text));
}

}  // namespace

std::string checksum(const std::string& text) {
  return digits(::crc32_z(0, reinterpret_cast<const Bytef*>(text.data()), text.size()));
}

std::string program_checksum() {
  std::ifstream file("/proc/self/exe", std::ios::binary);
  std::string chunk(std::size_t{1} << 20, '\0');
  uLong crc = 0;
  while (file.read(chunk.data(), static_cast<std::streamsize>(chunk.size())), file.gcount() > 0) {
    crc = ::crc32_z(crc, reinterpret_cast<const Bytef*>(chunk.data()),
                    static_cast<std::size_t>(file.gcount()));
  }
  return digits(crc);
}

Journal::Journal(const std::string& path) : path_(path), input_(path, std::ios::binary) {
  if (!input_) fail(std::strerror(errno));
  std::string line, begin, sum, head;
  std::getline(input_, line);
  std::istringstream words(line);
  words >> begin >> sum;
  std::getline(words >> std::ws, head);
  if (begin != kBegin) fail("it is no part of a sweep");
  if (input_.eof() || sum != checksum(head)) fail("its head is damaged or was changed");
  head_ = nlohmann::json::parse(head);
  end_ = line.size() + 1;
  scan();
}

Journal::Journal(const std::string& path, const nlohmann::json& head) : path_(path), head_(head) {
  take(::open(path_.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0666));
  const std::string text = head.dump();
  const std::string line = fmt::format("{} {} {}\n", kBegin, checksum(text), text);
  if (::write(::fileno(file_.get()), line.data(), line.size()) != static_cast<ssize_t>(line.size())) {
    fail(std::strerror(errno));
  }
  end_ = line.size();
  input_.open(path_, std::ios::binary);
}

void Journal::fail(const std::string& what) const {
  throw UsageError(fmt::format("{}: {}", printable(path_, kLongestPath), what));
}

void Journal::scan() {
  std::string line, text;
  while (std::getline(input_, line)) {
    is_whole_ = false;
    if (input_.eof()) return;  // no end of the line
    std::istringstream words(line);
    std::string word, sum;
    long block = -1;
    std::size_t size = 0;
    words >> word >> block >> size >> sum;
    if (!words || word != "block" || block < 0 || size > kLargestBlock) {
      fail(fmt::format("it is damaged or was changed at byte {}", end_));
    }
    text.resize(size);
    input_.read(text.data(), static_cast<std::streamsize>(size));
    if (static_cast<std::size_t>(input_.gcount()) < size) return;
    if (checksum_of_block(block, text) != sum) fail(fmt::format("block {} is damaged or was changed", block));
    const std::size_t offset = end_ + line.size() + 1;
    if (!blocks_.emplace(block, Record{offset, size}).second) {
      fail(fmt::format("block {} is there twice", block));
    }
    end_ = offset + size;
    is_whole_ = true;
  }
}

void Journal::open() { take(::open(path_.c_str(), O_WRONLY | O_CLOEXEC)); }

void Journal::take(int file) {
  if (file < 0) fail(std::strerror(errno));
  file_.reset(::fdopen(file, "w"));
  if (::flock(file, LOCK_EX | LOCK_NB) != 0) fail("another mbs sweep is writing it");
  if (::ftruncate(file, static_cast<off_t>(end_)) != 0 ||
      ::lseek(file, static_cast<off_t>(end_), SEEK_SET) < 0) {
    fail(std::strerror(errno));
  }
  is_whole_ = true;
}

void Journal::add(long block, const std::string& text) {
  const std::string head = fmt::format("block {} {} {}\n", block, text.size(), checksum_of_block(block, text));
  const std::string all = head + text;
  for (std::size_t done = 0; done < all.size();) {
    const ssize_t count = ::write(::fileno(file_.get()), all.data() + done, all.size() - done);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) fail(fmt::format("{} (what is done stays: --resume)", std::strerror(errno)));
    done += static_cast<std::size_t>(count);
  }
  blocks_[block] = {end_ + head.size(), text.size()};
  end_ += all.size();
}

std::string Journal::read(long block) const {
  const Record& record = blocks_.at(block);
  std::string text(record.size, '\0');
  input_.clear();
  input_.seekg(static_cast<std::streamoff>(record.offset));
  if (!input_.read(text.data(), static_cast<std::streamsize>(text.size()))) fail("it cannot be read");
  return text;
}

}  // namespace mbs
