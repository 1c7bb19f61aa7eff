// Google Benchmark's reports, with the names, numbers and privacy that results need.
#pragma once

#include <benchmark/benchmark.h>

#include <memory>
#include <span>
#include <string>
#include <vector>

namespace mbs {

/// Google Benchmark's JSON with three differences: a benchmark's name is the one it was registered
/// with (no "/manual_time"), a number that is not finite is null (JSON has no NaN), and the context
/// names neither the host nor the folder of the program.
class JsonReporter final : public benchmark::JSONReporter {
 public:
  bool ReportContext(const Context& context) override;
  void ReportRuns(const std::vector<Run>& runs) override;
  void Finalize() override;

  /// After the run: whether everything has reached the file.
  [[nodiscard]] bool complete() const { return complete_; }

 private:
  bool complete_ = false;
};

/// Any other reporter of Google Benchmark behind the names as registered, and only those counters
/// that are to be `shown`, as many as a line of a terminal has room for.
class DisplayReporter final : public benchmark::BenchmarkReporter {
 public:
  DisplayReporter(std::unique_ptr<benchmark::BenchmarkReporter> inner,
                  std::span<const char* const> shown)
      : inner_(std::move(inner)), shown_(shown.begin(), shown.end()) {}
  bool ReportContext(const Context& context) override { return inner_->ReportContext(context); }
  void ReportRuns(const std::vector<Run>& runs) override;
  void Finalize() override { inner_->Finalize(); }

 private:
  std::unique_ptr<benchmark::BenchmarkReporter> inner_;
  std::vector<std::string> shown_;
};

/// What the flags --benchmark_format and --benchmark_color ask for; call after Initialize().
std::unique_ptr<benchmark::BenchmarkReporter> make_display_reporter(
    std::span<const char* const> shown);

/// Replaces the values NaN, -NaN, Infinity and -Infinity by null in JSON with one member a line.
std::string without_non_finite(const std::string& json);

/// The opening of Google Benchmark's JSON, up to and including `"benchmarks": [`, without
/// `host_name` and with only the file name of `executable`.
std::string without_host(const std::string& opening);

}  // namespace mbs
