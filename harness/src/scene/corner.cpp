// Where a table is no smooth function, by divided differences.
#include <algorithm>
#include <cmath>

#include "model_math/largest.hpp"
#include "scene/time_functions.hpp"

namespace mbs {
namespace {

constexpr double kRounding = 1e-12;  // of the largest value: tables that vary by less are constant

double range_of(const std::vector<double>& values, std::size_t first, std::size_t last) {
  const auto begin = values.begin() + static_cast<std::ptrdiff_t>(first);
  const auto end = values.begin() + static_cast<std::ptrdiff_t>(last) + 1;
  const auto [least, most] = std::minmax_element(begin, end);
  return *most - *least;
}

/// What the polynomial through the rows first ... last, without `row`, has at `row`.
double without(std::size_t row, std::size_t first, std::size_t last,
               const std::vector<double>& times, const std::vector<double>& values) {
  double sum = 0.0;
  for (std::size_t i = first; i <= last; ++i) {
    if (i == row) continue;
    double weight = 1.0;
    for (std::size_t k = first; k <= last; ++k) {
      if (k != i && k != row) weight *= (times[row] - times[k]) / (times[i] - times[k]);
    }
    sum += weight * values[i];
  }
  return sum;
}

/// A row that the rows around it do not lead to.
std::optional<std::size_t> stray_of(const std::vector<double>& times,
                                    const std::vector<double>& values, double range) {
  const std::size_t rows = times.size();
  for (std::size_t i = 1; i + 1 < rows; ++i) {
    const std::size_t first =
        std::min(std::max<std::size_t>(i, 2) - 2, rows - std::min<std::size_t>(rows, 5));
    const std::size_t last = std::min(first + 4, rows - 1);
    const double around =
        range_of(values, std::max<std::size_t>(i, 3) - 3, std::min(i + 3, rows - 1));
    const double off = std::min(std::abs(without(i, first, last, times, values) - values[i]),
                                std::abs(without(i, i - 1, i + 1, times, values) - values[i]));
    if (off > kStrayShare * around && off > kCornerJump * range) return i;
  }
  return std::nullopt;
}

/// A row at which the slope jumps while it hardly changes before and after.
std::optional<std::size_t> jump_of(const std::vector<double>& times,
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
    for (const std::size_t k : {i - 2, i - 1, j + 1, j + 2}) {  // i - 2 may wrap: past the end
      if (k < 1 || k >= rows - 1) continue;
      around = std::max(around, bend[k]);
    }
    const std::size_t sharper = bend[i] >= bend[j] ? i : j;
    const bool is_known = i >= 3 || j + 3 < rows;  // two rows on one side
    if (is_known && bend[sharper] > kCornerRatio * around &&
        jump[sharper] > kCornerJump * steepest) {
      return sharper;
    }
  }
  return std::nullopt;
}

}  // namespace

std::optional<std::size_t> corner_of(const std::vector<double>& times,
                                     const std::vector<double>& values) {
  const double range = range_of(values, 0, values.size() - 1);
  if (range <= kRounding * largest_of(values)) return std::nullopt;
  const auto jump = jump_of(times, values);
  return jump ? jump : stray_of(times, values, range);
}

}  // namespace mbs
