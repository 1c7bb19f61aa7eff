#include "predicted_time.hpp"

#include <algorithm>
#include <cmath>

#include "program.hpp"

namespace mbs::compiled_ldl {

/// Constants fitted to measurements of the standard scenes and of filled four-bars, each in several
/// orders.
FrontTime front_time(int pivots, int border, int nodes, int width) {
  if (width == 1) {  // many side by side: arithmetic counts, others fill what is left
    const double rows = pivots + border;
    return {10.0 + 20.0 * pivots + 0.7 * pivots * rows * rows, 0.0};
  }
  FrontTime time;
  for (int from = 0; from < pivots; from += kPanel) {
    const int panel = std::min(kPanel, pivots - from), inside = pivots - from - panel;
    const double packs = std::ceil(static_cast<double>(inside + border) / width);
    time.work += panel * (20.0 + packs * (panel + 0.35 * inside));
    time.latency += 5.0 * std::ceil(panel / 2.0);  // a division for two pivots
    if (border == 2 && nodes == 1) {
      time.work += 10.0;
      time.latency += 15.0;  // Panels::update_two(): a vector waits for stores of single numbers
    } else {
      time.work += border * (17.5 + packs * (5.0 + 0.2 * panel));
    }
  }
  return time;
}

/// A front waits for its children, until the work of those before it has been taken up, and until
/// all of those but the last are done.
double predicted_cycles(const std::vector<FrontTime>& fronts, const std::vector<int>& parents) {
  std::vector<double> ready(fronts.size(), 0.0);
  double entry = 0.0, done = 0.0, done_before = 0.0;  // done_before: all but the last
  for (std::size_t k = 0; k < fronts.size(); ++k) {
    entry = std::max(entry, done_before);
    const double end = std::max(entry, ready[k]) + fronts[k].work + fronts[k].latency;
    if (parents[k] >= 0) ready[parents[k]] = std::max(ready[parents[k]], end);
    done_before = done;
    done = std::max(done, end);
    entry += fronts[k].work;
  }
  return done;
}

}  // namespace mbs::compiled_ldl
