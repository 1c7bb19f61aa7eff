// Statistics of samples that were taken side by side.
#pragma once

#include <span>
#include <vector>

namespace mbs {

/// The middle value, or the mean of the two in the middle; `values` must not be empty.
double median(std::vector<double> values);

/// The median of times[j] / base[j] over the samples j, and order statistics around it.
struct PairedRatio {
  double ratio = 1.0;
  double low = 1.0, high = 1.0;
  double confidence = 0.0;  ///< that low ... high has the median: 0.95 or a little more, or less
                            ///< where even the least and the largest of few samples do not reach it
};

/// Pairs cancel what slows both. The interval assumes nothing about the distribution: the number of
/// ratios below the median is binomial [David and Nagaraja, Order Statistics, 2003, section 7.1].
/// @param times, base s, equally many and at least one
PairedRatio paired_ratio(std::span<const double> times, std::span<const double> base);

}  // namespace mbs
