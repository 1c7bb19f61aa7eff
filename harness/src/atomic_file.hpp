// Files that appear whole or not at all.
#pragma once

#include <fstream>
#include <string>

namespace mbs {

/// Whether `path` names what is open already: a pipe with both its ends, or a file to be kept.
bool is_open_already(const std::string& path);

/// What the names of files begin with that are to become the file `name`, in its folder: `name`,
/// cut where the rest would not go into the 255 bytes that most systems allow.
std::string partial_begin(const std::string& name);

/// Writes to a file of its own beside `path` and renames it on commit(); without a commit nothing
/// stays, also when a signal from outside ends the program (a reader that left, a limit of time).
/// Links are followed, devices and what is open already (/dev/stdout) written to directly. Up to
/// four at a time.
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
  /// The file that is written to until commit(): for a library that opens it by name.
  [[nodiscard]] const std::string& partial() const { return partial_; }
  /// Throws UsageError if not everything could be written.
  void commit();

 private:
  std::string name_;  // as given, for messages
  std::string path_;  // links resolved
  std::string partial_;
  std::ofstream stream_;
};

}  // namespace mbs
