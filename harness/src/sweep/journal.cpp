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
#include <string_view>

#include "printable.hpp"
#include "usage_error.hpp"

namespace mbs {
namespace {

constexpr std::string_view kBegin = "mbs-sweep ";
constexpr std::size_t kLargestBlock = std::size_t{1} << 30;

std::string digits(uLong crc) { return fmt::format("{:08x}", crc); }

std::string checksum_of_block(long block, const std::string& text) {
  return checksum(fmt::format("{}\n{}", block, text));
}

/// False on failure, which errno names.
bool append_all(int file, std::string_view text) {
  while (!text.empty()) {
    const ssize_t count = ::write(file, text.data(), text.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    text.remove_prefix(static_cast<std::size_t>(count));
  }
  return true;
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
  if (!read_head()) fail("it is no part of a sweep");
  scan();
}

Journal::Journal(const std::string& path, const nlohmann::json& head) : path_(path) {
  const std::string text = head.dump();  // what cannot be written leaves no file
  const int file = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0666);
  if (file < 0) fail(std::strerror(errno));
  file_.reset(::fdopen(file, "w"));
  if (::flock(file, LOCK_EX | LOCK_NB) != 0) {
    fail(errno == EWOULDBLOCK ? "another mbs sweep is writing it" : std::strerror(errno));
  }
  input_.open(path_, std::ios::binary);  // locked first: nothing is added to what is read
  if (!input_) fail(std::strerror(errno));
  if (read_head()) {
    scan();
    if (!end_at(end_)) fail(std::strerror(errno));
    is_whole_ = true;
  } else {
    begin(fmt::format("{}{} {}\n", kBegin, checksum(text), text));
    head_ = head;
  }
}

/// False where none was written to its end.
bool Journal::read_head() {
  std::string line, begin, sum, head;
  std::getline(input_, line);
  if (!kBegin.starts_with(line.substr(0, kBegin.size()))) fail("it is no part of a sweep");
  if (input_.eof()) return false;
  std::istringstream words(line);
  words >> begin >> sum;
  std::getline(words >> std::ws, head);
  if (sum != checksum(head)) fail("its head is damaged or was changed");
  head_ = nlohmann::json::parse(head);
  end_ = line.size() + 1;
  return true;
}

void Journal::begin(const std::string& line) {
  if (!end_at(0) || !append_all(::fileno(file_.get()), line)) {
    const int error = errno;
    ::unlink(path_.c_str());
    fail(std::strerror(error));
  }
  end_ = line.size();
}

/// Cuts what is behind, and goes on writing there.
bool Journal::end_at(std::size_t size) {
  const int file = ::fileno(file_.get());
  const auto end = static_cast<off_t>(size);
  return ::ftruncate(file, end) == 0 && ::lseek(file, end, SEEK_SET) == end;
}

void Journal::fail(const std::string& what) const {
  throw UsageError(fmt::format("{}: {}", printable(path_, kLongestPath), what));
}

void Journal::scan() {
  input_.clear();
  input_.seekg(static_cast<std::streamoff>(end_));
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
    if (checksum_of_block(block, text) != sum) {
      const bool is_last = input_.peek() == std::ifstream::traits_type::eof();
      if (is_last && file_) return;  // it is done again
      fail(fmt::format("block {} is damaged or was changed", block));
    }
    const std::size_t offset = end_ + line.size() + 1;
    if (!blocks_.emplace(block, Record{offset, size}).second) {
      fail(fmt::format("block {} is there twice", block));
    }
    end_ = offset + size;
    is_whole_ = true;
  }
}

void Journal::add(long block, const std::string& text) {
  const int file = ::fileno(file_.get());
  const off_t begin = ::lseek(file, 0, SEEK_CUR);  // copies of this process move it too
  const std::string head = fmt::format("block {} {} {}\n", block, text.size(), checksum_of_block(block, text));
  if (append_all(file, head + text)) return;
  const int error = errno;
  end_at(static_cast<std::size_t>(begin));  // others may find room for theirs
  fail(fmt::format("{} (what is done stays: --resume)", std::strerror(error)));
}

std::string Journal::read(long block) const {
  const auto found = blocks_.find(block);
  if (found == blocks_.end()) fail(fmt::format("block {} is not there", block));
  const auto [offset, size] = found->second;
  std::string text(size, '\0');
  input_.clear();
  input_.seekg(static_cast<std::streamoff>(offset));
  if (!input_.read(text.data(), static_cast<std::streamsize>(size))) fail("it cannot be read");
  return text;
}

}  // namespace mbs
