// Reads the library's own variables.
#include "mbs/bench_flags.hpp"

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "usage_error.hpp"

// The library exports all of its flags, but has no header and no accessor for these.
namespace benchmark {
extern std::string FLAGS_benchmark_out;
extern std::string FLAGS_benchmark_out_format;
extern std::string FLAGS_benchmark_format;
extern bool FLAGS_benchmark_list_tests;
extern double FLAGS_benchmark_min_time;
extern int32_t FLAGS_benchmark_repetitions;
}  // namespace benchmark

namespace mbs {
namespace {

/// Whether a flag is on the command line, or in the environment as the library reads it.
bool is_given(int argc, char** argv, const std::string& name) {
  std::string variable = name;
  std::ranges::transform(variable, variable.begin(),
                         [](char c) { return static_cast<char>(std::toupper(c)); });
  if (std::getenv(variable.c_str()) != nullptr) return true;
  return std::any_of(argv + 1, argv + argc, [&](const char* argument) {
    return std::string(argument).starts_with("--" + name + "=");
  });
}

void check_flags(bool out) {
  if (out && benchmark::FLAGS_benchmark_out.empty()) {
    throw UsageError("--benchmark_out= names no file");
  }
  if (benchmark::FLAGS_benchmark_out_format != "json") {
    throw UsageError(fmt::format("--benchmark_out_format={}: results are written as json only",
                                 benchmark::FLAGS_benchmark_out_format));
  }
  if (!(benchmark::FLAGS_benchmark_min_time >= 0.0 && benchmark::FLAGS_benchmark_min_time < 1e6)) {
    throw UsageError(fmt::format("--benchmark_min_time={}: it must be 0 to 1e6 s",
                                 benchmark::FLAGS_benchmark_min_time));
  }
  if (benchmark::FLAGS_benchmark_repetitions < 1 ||
      benchmark::FLAGS_benchmark_repetitions > 10000) {
    throw UsageError(fmt::format("--benchmark_repetitions={}: it must be 1 to 10000",
                                 benchmark::FLAGS_benchmark_repetitions));
  }
}

}  // namespace

BenchFlags take_benchmark_flags(int& argc, char** argv) {
  BenchFlags flags;
  const bool min_time = is_given(argc, argv, "benchmark_min_time");
  const bool repetitions = is_given(argc, argv, "benchmark_repetitions");
  const bool out = is_given(argc, argv, "benchmark_out");
  const bool format = is_given(argc, argv, "benchmark_format");
  benchmark::Initialize(&argc, argv, [] {
    // Help never comes here; for a wrong value the library prints its usage and exits with status
    // 0.
    throw UsageError(
        "--benchmark_format is one of console, json, csv; --benchmark_out_format is json; "
        "--benchmark_time_unit is one of ns, us, ms, s");
  });
  check_flags(out);
  flags.filter = benchmark::GetBenchmarkFilter();
  flags.out = benchmark::FLAGS_benchmark_out;
  flags.format = benchmark::FLAGS_benchmark_format;
  flags.format_given = format;
  flags.list_tests = benchmark::FLAGS_benchmark_list_tests;
  if (min_time) flags.min_time = benchmark::FLAGS_benchmark_min_time;
  if (repetitions) flags.repetitions = benchmark::FLAGS_benchmark_repetitions;
  return flags;
}

void redirect_benchmark_out(const std::string& path) { benchmark::FLAGS_benchmark_out = path; }

}  // namespace mbs
