// Micro-benchmarks: chains of dependent operations, many independent ones, and streams.
#include "limit/machine.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <fstream>
#include <limits>
#include <string_view>

namespace mbs::limit {
namespace {

#if defined(__AVX512F__)
constexpr int kWidest = 64;
#elif defined(__AVX__)
constexpr int kWidest = 32;
#else
constexpr int kWidest = 16;
#endif
using Wide = double __attribute__((vector_size(kWidest)));
constexpr int kLanes = kWidest / static_cast<int>(sizeof(double));

/// The compiler must take `x` for unknown.
template <class V>
MBS_LIMIT_INLINE void hide(V& x) {
#if defined(__x86_64__)
  asm volatile("" : "+x"(x));
#else
  asm volatile("" : "+w"(x));
#endif
}

/// Shortest run of `work`, ns, of as many as 30 ms have room for, but at least five.
template <class Work>
double shortest(const Work& work) {
  using Clock = std::chrono::steady_clock;
  const auto nanoseconds = [](Clock::duration time) {
    return std::chrono::duration<double, std::nano>(time).count();
  };
  double best = std::numeric_limits<double>::infinity();
  const auto start = Clock::now();
  for (int runs = 0; runs < 5 || nanoseconds(Clock::now() - start) < 3e7; ++runs) {
    const auto begin = Clock::now();
    work();
    best = std::min(best, nanoseconds(Clock::now() - begin));
  }
  return best;
}

/// ns from an operation's operand to its result.
template <class Operation>
double latency(const Operation& operation) {
  constexpr int kLength = 1000;
  const double all = shortest([&] {
    Pair x{1.5, 1.25};
    for (int i = 0; i < kLength; ++i) {
      x = operation(x);
      hide(x);
    }
  });
  return all / kLength;
}

/// Operations on single numbers per ns, many of them independent.
template <class Operation>
double rate(const Operation& operation) {
  constexpr int kLength = 500;
  const Wide start = Wide{} + 1.5;
  const double all = shortest([&] {
    Wide a = start, b = a, c = a, d = a, e = a, f = a, g = a, h = a, k = a, l = a;
    for (int i = 0; i < kLength; ++i) {
      a = operation(a), b = operation(b), c = operation(c), d = operation(d), e = operation(e);
      f = operation(f), g = operation(g), h = operation(h), k = operation(k), l = operation(l);
      hide(a), hide(b), hide(c), hide(d), hide(e), hide(f), hide(g), hide(h), hide(k), hide(l);
    }
  });
  return 10.0 * kLanes * kLength / all;
}

/// Bytes loaded and stored per ns over and over a range of `bytes`.
double bandwidth(std::size_t bytes) {
  std::vector<Wide> range(bytes / sizeof(Wide), Wide{} + 1.0);
  const std::size_t rounds = std::max<std::size_t>(1, 100'000 / bytes);
  Wide factor = Wide{} + 1.0;
  hide(factor);
  const double all = shortest([&] {
    for (std::size_t round = 0; round < rounds; ++round) {
      Wide* const data = range.data();
      for (std::size_t i = 0; i < range.size(); ++i) data[i] *= factor;
      asm volatile("" : : "r"(data) : "memory");
    }
  });
  return 2.0 * static_cast<double>(rounds * range.size() * sizeof(Wide)) / all;
}

/// The first line of a file; empty if there is none.
std::string first_line(const std::string& path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  return line;
}

/// Bytes of the first processor's data cache of a level, or `usual` where the system does not tell.
std::size_t capacity(int level, std::size_t usual) {
  for (int i = 0; i < 8; ++i) {
    const std::string cache = fmt::format("/sys/devices/system/cpu/cpu0/cache/index{}/", i);
    if (first_line(cache + "level") != std::to_string(level)) continue;
    if (first_line(cache + "type") == "Instruction") continue;
    const std::string size = first_line(cache + "size");  // for instance "32K"
    std::size_t kilobytes = 0;
    const auto [end, error] = std::from_chars(size.data(), size.data() + size.size(), kilobytes);
    if (error == std::errc{} && kilobytes > 0 && std::string_view(end) == "K") {
      return kilobytes << 10;
    }
  }
  return usual;
}

}  // namespace

const Level& Machine::level_of(std::size_t bytes) const {
  return *std::find_if(levels.begin(), levels.end() - 1,
                       [bytes](const Level& level) { return bytes <= level.bytes; });
}

Machine measure_machine() {
  Machine machine;
  machine.vector_bytes = kWidest;
  Pair y{1.0, 1.0};
  hide(y);
  machine.latencies = {
      .add = latency([y](const Pair& x) { return x + y; }),
      .multiply = latency([y](const Pair& x) { return x * y; }),
      .fused = latency([y](const Pair& x) { return fma(x, y, y); }),
      .divide = latency([y](const Pair& x) { return y / x; }),
  };
  Wide one = Wide{} + 1.0;
  hide(one);
  machine.peak = 2.0 * rate([one](const Wide& x) { return x * one + one; });
  machine.divisions = rate([one](const Wide& x) { return one / x; });
  const std::size_t first = capacity(1, std::size_t{32} << 10);
  const std::size_t second = capacity(2, std::size_t{1} << 20);
  const std::size_t third = capacity(3, std::size_t{16} << 20);
  machine.levels = {{"L1", first, bandwidth(first / 2)},
                    {"L2", second, bandwidth(second / 2)},
                    {"L3", third, bandwidth(std::min(third / 4, 8 * second))},
                    {"memory", std::numeric_limits<std::size_t>::max(), bandwidth(2 * third)}};
  return machine;
}

}  // namespace mbs::limit
