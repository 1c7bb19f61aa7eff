// The file that `mbs bench` writes its results to.
#pragma once

#include <string>

namespace mbs {

/// Results go to "<out>.partial", to be renamed when they are complete, so that an interrupted run
/// leaves older results alone; to a device they go directly.
class BenchOutput {
 public:
  /// @param out as given; empty: no file. Throws UsageError if nothing can be written there.
  explicit BenchOutput(const std::string& out);

  /// What to write to; empty: nothing.
  [[nodiscard]] const std::string& path() const { return path_; }
  /// Throws UsageError unless the results are `complete` and in their place.
  void finish(bool complete) const;

 private:
  std::string path_;
  std::string rename_to_;  ///< empty: it stays where it is
};

}  // namespace mbs
