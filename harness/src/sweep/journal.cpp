// A block is a line "block NUMBER SIZE CHECKSUM CHECKSUM", then so many bytes. The first checksum
// is of these, the second of the line before it: a wrong size would hide all that is behind.
#include "sweep/journal.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>
#include <zlib.h>

#include <cerrno>
#include <cstring>
#include <optional>
#include <sstream>
#include <string_view>

#include "printable.hpp"
#include "usage_error.hpp"

namespace mbs {
namespace {

constexpr std::string_view kBegin = "mbs-sweep-2 ", kBlock = "block ";
constexpr std::size_t kLargestBlock = std::size_t{1} << 30;

std::string digits(uLong crc) { return fmt::format("{:08x}", crc); }

struct Header {
  std::size_t begin = 0;  // in its line
  long block = 0;
  std::size_t size = 0;
  std::string sum = {};
};

std::string line_of_block(long block, const std::string& text) {
  const std::string line = fmt::format("{}{} {} {}", kBlock, block, text.size(), checksum(text));
  return fmt::format("{} {}\n", line, checksum(line));
}

/// Of the line at whose end it is: what is before it may be the end of a damaged block.
std::optional<Header> header_in(const std::string& line) {
  const std::size_t last = line.rfind(' ');
  const std::size_t begin = last == std::string::npos ? last : line.rfind(kBlock, last);
  if (begin == std::string::npos) return std::nullopt;
  const std::string summed = line.substr(begin, last - begin);
  if (checksum(summed) != line.substr(last + 1)) return std::nullopt;
  std::istringstream words(summed.substr(kBlock.size()));
  Header header{begin};
  words >> header.block >> header.size >> header.sum;
  if (!words || header.block < 0 || header.size > kLargestBlock) return std::nullopt;
  return header;
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
  if (!read_head()) fail("it is no part of a sweep by this version of mbs");
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
  } else {
    begin(fmt::format("{}{} {}\n", kBegin, checksum(text), text));
    head_ = head;
  }
}

/// False where none was written to its end.
bool Journal::read_head() {
  std::string line, begin, sum, head;
  std::getline(input_, line);
  if (!kBegin.starts_with(line.substr(0, kBegin.size())))
    fail("it is no part of a sweep by this version of mbs");
  if (input_.eof()) return false;
  std::istringstream words(line);
  words >> begin >> sum;
  std::getline(words >> std::ws, head);
  if (sum != checksum(head)) {
    fail("its head is damaged or was changed, nothing can be done with it but to remove it");
  }
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
  std::string line;
  bool is_cut = false;  // what is behind end_ is a block that was not written to its end
  for (std::size_t at = end_;;) {
    input_.clear();
    input_.seekg(static_cast<std::streamoff>(at));
    std::getline(input_, line);
    if (input_.eof()) return;  // no end of the line
    const auto header = header_in(line);
    const std::size_t begin = at + (header ? header->begin : 0);
    at += line.size() + 1;
    const auto text = header ? read_at(at, header->size) : std::nullopt;
    const bool is_block = text && checksum(*text) == header->sum;
    is_cut = !is_block && (is_cut || (begin == end_ && header && !text));
    if (!damage_ && (is_block ? begin > end_ : !is_cut)) damage_ = end_;
    if (!is_block) continue;  // one may begin at any later line
    if (!blocks_.emplace(header->block, Record{at, header->size}).second) {
      fail(fmt::format("block {} is there twice", header->block));
    }
    end_ = at += header->size;
  }
}

/// Nothing where the file ends before.
std::optional<std::string> Journal::read_at(std::size_t offset, std::size_t size) const {
  std::string text(size, '\0');
  input_.clear();
  input_.seekg(static_cast<std::streamoff>(offset));
  input_.read(text.data(), static_cast<std::streamsize>(size));
  if (static_cast<std::size_t>(input_.gcount()) < size) return std::nullopt;
  return text;
}

void Journal::add(long block, const std::string& text) {
  const int file = ::fileno(file_.get());
  const off_t begin = ::lseek(file, 0, SEEK_CUR);  // copies of this process move it too
  if (append_all(file, line_of_block(block, text) + text)) return;
  const int error = errno;
  end_at(static_cast<std::size_t>(begin));  // others may find room for theirs
  fail(fmt::format("{} (what is done stays: --resume)", std::strerror(error)));
}

std::string Journal::read(long block) const {
  const auto found = blocks_.find(block);
  if (found == blocks_.end()) fail(fmt::format("block {} is not there", block));
  auto text = read_at(found->second.offset, found->second.size);
  if (!text) fail("it cannot be read");
  return *std::move(text);
}

}  // namespace mbs
