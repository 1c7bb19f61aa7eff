// Pieces of 1, 1, 2, 4 ... steps.
#include "bench/warm_up.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace mbs {

void WarmUp::look(double enough, double hopeless) {
  constexpr int kSteps = 16;
  constexpr double kSeconds = 1e-3;  // with fewer, the clock and cold caches decide
  constexpr double kLongest = 1.0;   // s
  while (done_ < steps_ && (done_ < kSteps || seconds() < kSeconds)) {
    advance();
    if (done_ < 2 && step_seconds_ <= hopeless) continue;
    if (seconds() > kLongest || (step_seconds_ > enough && seconds() > kSeconds)) break;
  }
}

void WarmUp::finish() {
  while (done_ < steps_) advance();
}

void WarmUp::advance() {
  if (done_ == 0) measurement_->start();
  int piece = std::clamp(done_, 1, steps_ - done_);
  if (patience_ && done_ > 0) {
    const double each = std::max(spent_.seconds / done_, 1e-9);
    piece = static_cast<int>(std::clamp<double>((*patience_ - spent_.seconds) / each, 1, piece));
  }
  const Spent spent = measurement_->advance(piece);
  done_ += piece;
  spent_ += spent;
  step_seconds_ = spent.cpu_seconds / piece;
  if (patience_ && spent_.seconds > *patience_ && done_ < steps_) {
    throw CellFailure(
        fmt::format("slower: did not finish the stretch of {} steps within {:g} s (first {} "
                    "step{} took {:.3g} s)",
                    steps_, *patience_, done_, done_ == 1 ? "" : "s", spent_.seconds));
  }
}

}  // namespace mbs
