// The file that `mbs bench` writes its results to.
#pragma once

#include <fmt/format.h>

#include <optional>
#include <string>

#include "atomic_file.hpp"
#include "usage_error.hpp"

namespace mbs {

/// Google Benchmark writes it by its name; an interrupted run leaves older results alone.
class BenchOutput {
 public:
  /// @param out as given; empty: no file. Throws UsageError if nothing can be written there.
  explicit BenchOutput(const std::string& out) {
    if (!out.empty()) file_.emplace(out);
  }

  /// What to write to; empty: nothing.
  [[nodiscard]] std::string path() const { return file_ ? file_->partial() : ""; }
  /// Throws UsageError unless the results are `complete` and in their place.
  void finish(bool complete) {
    if (!file_) return;
    if (!complete) {
      throw UsageError(
          fmt::format("--benchmark_out: {} could not be written to its end", path()));
    }
    file_->commit();
  }

 private:
  std::optional<AtomicFile> file_;
};

}  // namespace mbs
