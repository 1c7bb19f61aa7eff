// Time that short pieces of work take together, without a clock that takes as long as they do.
#pragma once

#include <chrono>
#include <cstdint>

namespace mbs {

/// Times the first laps, of which the first may take much longer, and then one in eight, at uneven
/// places, which stand for the others. What reading the clock takes does not count.
///
///   SampledTime time;
///   time.begin();
///   work();
///   time.end();
///   double seconds = time.total();
class SampledTime {
 public:
  using Clock = std::chrono::steady_clock;
  static constexpr std::uint64_t kFirst = 16;  // laps

  void begin() {
    // Multiples of the golden ratio, an eighth of which are below an eighth.
    constexpr std::uint64_t kGoldenRatio = 0x9E3779B97F4A7C15U;
    is_timed_ = laps_ <= kFirst || laps_ * kGoldenRatio >> 61U == 0;
    if (is_timed_) begin_ = Clock::now();
  }
  /// `aside` (s) of it was something else.
  void end(double aside = 0.0) {
    if (is_timed_) add(since(begin_) - aside);
    ++laps_;
  }
  /// s
  [[nodiscard]] static double since(Clock::time_point begin) {
    return std::chrono::duration<double>(Clock::now() - begin).count();
  }
  /// Of all laps so far, s.
  [[nodiscard]] double total() const;

 private:
  void add(double time);

  Clock::time_point begin_;
  bool is_timed_ = false;
  std::uint64_t laps_ = 0, samples_ = 0;  // samples_: that were timed after the first
  double first_ = 0.0, later_ = 0.0;      // s
};

}  // namespace mbs
