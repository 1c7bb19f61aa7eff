// A text that is written in pieces and appears whole or not at all; compressed where its name ends in ".gz".
#pragma once

#include <memory>
#include <string>

#include "atomic_file.hpp"

namespace mbs {

class TableFile {
 public:
  /// Throws UsageError if `path` cannot be written.
  explicit TableFile(const std::string& path);
  void write(const std::string& text);
  /// Throws UsageError if not everything could be written.
  void commit();

 private:
  struct Close {
    void operator()(void* file) const;
  };
  [[noreturn]] void fail() const;

  std::string path_;
  AtomicFile file_;
  std::unique_ptr<void, Close> compressed_;  // zlib's
};

}  // namespace mbs
