// zlib writes to the file that is renamed later.
#include "mbs/table_file.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <cerrno>
#include <cstring>

#include "usage_error.hpp"

namespace mbs {

void TableFile::Close::operator()(void* file) const { ::gzclose(static_cast<gzFile>(file)); }

TableFile::TableFile(const std::string& path) : path_(path), file_(path) {
  if (!path.ends_with(".gz")) return;
  compressed_.reset(::gzopen(file_.partial().c_str(), "wb"));
  if (!compressed_) fail();
}

void TableFile::write(const std::string& text) {
  if (!compressed_) {
    if (!(file_.stream() << text)) fail();
  } else if (!text.empty() &&
             ::gzwrite(static_cast<gzFile>(compressed_.get()), text.data(),
                       static_cast<unsigned>(text.size())) != static_cast<int>(text.size())) {
    fail();
  }
}

void TableFile::commit() {
  if (compressed_ && ::gzclose(static_cast<gzFile>(compressed_.release())) != Z_OK) fail();
  file_.commit();
}

void TableFile::fail() const {
  throw UsageError(fmt::format("cannot write '{}': {}", path_, std::strerror(errno)));
}

}  // namespace mbs
