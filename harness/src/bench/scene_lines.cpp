// Sorts contenders and writes ratios.
#include "bench/scene_lines.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "bench/paired_ratio.hpp"

namespace mbs {

std::vector<ContenderLine> contender_lines(const SceneResult& scene) {
  std::vector<ContenderLine> lines;
  for (const ContenderResult& contender : scene.contenders) {
    ContenderLine& line = lines.emplace_back(
        ContenderLine{&contender, contender.cell->variant_name(), contender.step_times()});
    if (!line.times.empty()) line.middle = median(line.times);
  }
  std::ranges::stable_sort(lines, [](const ContenderLine& a, const ContenderLine& b) {
    if (a.times.empty() != b.times.empty()) return b.times.empty();
    return a.middle < b.middle;
  });
  return lines;
}

std::string paired_ratio_text(const ContenderLine& line, const ContenderLine& fastest) {
  const PairedRatio ratio = paired_ratio(line.times, fastest.times);
  const int digits = ratio.ratio < 10 ? 3 : ratio.ratio < 100 ? 2 : ratio.ratio < 1000 ? 1 : 0;
  if (line.times.size() < 2) return fmt::format("{:.{}f}", ratio.ratio, digits);
  return fmt::format("{:.{}f} ({:.{}f}..{:.{}f})", ratio.ratio, digits, ratio.low, digits,
                     ratio.high, digits);
}

double clock_factor(const SceneResult& scene) {
  Spent total;
  for (const ContenderResult& contender : scene.contenders) {
    if (contender.cell->control) continue;  // all of it is reading clocks
    for (const Sample& sample : contender.samples) total += sample.spent;
  }
  return total.cpu_seconds > 0.0 ? total.seconds / total.cpu_seconds : 1.0;
}

}  // namespace mbs
