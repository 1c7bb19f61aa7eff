// Files that appear whole or not at all.
#pragma once

#include <fstream>
#include <string>

namespace mbs {

/// Writes to "<path>.partial" and renames it to `path` on commit(); without a commit nothing stays.
///
///   AtomicFile file("summary.json");
///   file.stream() << text;
///   file.commit();
class AtomicFile {
 public:
  /// Throws UsageError if the file cannot be created.
  explicit AtomicFile(std::string path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  std::ostream& stream() { return stream_; }
  /// Throws UsageError if not everything could be written.
  void commit();

 private:
  std::string path_;
  std::string partial_;
  std::ofstream stream_;
};

}  // namespace mbs
