// Draws over the same line.
#include "mbs/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <utility>

namespace mbs {

Progress::Progress(double total, std::string unit)
    : total_(total), unit_(std::move(unit)), shown_(::isatty(STDERR_FILENO) != 0) {}

Progress::~Progress() {
  if (percent_ >= 0) fmt::print(stderr, "\r{:70}\r", "");
}

void Progress::at(double done) {
  const int percent = std::clamp(static_cast<int>(100 * done / total_), 0, 100);
  if (!shown_ || percent == percent_) return;
  percent_ = percent;
  const int filled = percent / 5;
  fmt::print(stderr, "\r[{:#<{}}{:-<{}}] {:3} %  {:.4g} of {:.4g} {}  ", "", filled, "",
             20 - filled, percent, done, total_, unit_);
  std::fflush(stderr);
}

void show_doing(const std::string& what) {
  constexpr int kWidth = 78;
  if (::isatty(STDERR_FILENO) == 0) return;
  fmt::print(stderr, "\r{:{}.{}}\r{:.{}}", "", kWidth, kWidth, what, kWidth);
  std::fflush(stderr);
}

}  // namespace mbs
