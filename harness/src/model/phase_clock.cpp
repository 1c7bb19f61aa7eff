// The phase clock's tick source and bookkeeping.
#include "mbs/phase_clock.hpp"

#if defined(__x86_64__)
#include <x86intrin.h>
#else
#include <chrono>
#endif

namespace mbs {

std::uint64_t PhaseClock::now() noexcept {
#if defined(__x86_64__)
  return __rdtsc();
#else
  return static_cast<std::uint64_t>(std::chrono::duration_cast<std::chrono::nanoseconds>(
                                        std::chrono::steady_clock::now().time_since_epoch())
                                        .count());
#endif
}

void PhaseClock::book(Phase next) noexcept {
  const std::uint64_t time = now();
  ticks_[static_cast<std::size_t>(current_)] += time - last_;
  current_ = next;
  last_ = time;
}

}  // namespace mbs
