// Google Benchmark's flags, as far as `mbs bench` needs them.
#pragma once

#include <optional>
#include <string>

namespace mbs {

struct BenchFlags {
  std::string filter, out;
  std::string format;         ///< console, json or csv
  bool format_given = false;  ///< or else the default
  bool list_tests = false;
  std::optional<double> min_time;  ///< s, if given
  std::optional<int> repetitions;  ///< if given
};

/// Takes Google Benchmark's flags out of argv. Throws UsageError for values that the library would
/// not survive, or that mean nothing here.
BenchFlags take_benchmark_flags(int& argc, char** argv);

/// Has RunSpecifiedBenchmarks() write to another file than the one that was given.
void redirect_benchmark_out(const std::string& path);

}  // namespace mbs
