// Where a table has a corner, by its second divided differences.
#include <algorithm>
#include <cmath>

#include "scene/time_functions.hpp"

namespace mbs {

std::optional<std::size_t> corner_of(const std::vector<double>& times,
                                     const std::vector<double>& values) {
  const std::size_t rows = times.size();
  std::vector<double> bend(rows, 0.0), jump(rows, 0.0);  // at the inner rows
  double steepest = 0.0;
  for (std::size_t i = 1; i < rows; ++i) {
    const double slope = (values[i] - values[i - 1]) / (times[i] - times[i - 1]);
    steepest = std::max(steepest, std::abs(slope));
    if (i + 1 == rows) break;
    jump[i] = std::abs((values[i + 1] - values[i]) / (times[i + 1] - times[i]) - slope);
    bend[i] = 2 * jump[i] / (times[i + 1] - times[i - 1]);
  }
  for (std::size_t i = 1; i + 1 < rows; ++i) {
    const std::size_t j = std::min(i + 1, rows - 2);
    double around = 0.0;
    bool has_neighbour = false;
    for (const std::size_t k : {i - 2, i - 1, j + 1, j + 2}) {  // i - 2 may wrap: past the end
      if (k < 1 || k >= rows - 1) continue;
      around = std::max(around, bend[k]);
      has_neighbour = true;
    }
    const std::size_t sharper = bend[i] >= bend[j] ? i : j;
    if (has_neighbour && bend[sharper] > kCornerRatio * around &&
        jump[sharper] > kCornerJump * steepest) {
      return sharper;
    }
  }
  return std::nullopt;
}

}  // namespace mbs
