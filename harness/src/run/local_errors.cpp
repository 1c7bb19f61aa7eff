// One pass over the points.
#include "run/local_errors.hpp"

#include <algorithm>
#include <cmath>

#include "run/scene_distance.hpp"

namespace mbs {

void LocalErrors::take(std::span<const double> off, std::span<const double> v) {
  point_vectors(scene_, length_, off, error_);
  point_vectors(scene_, length_, v, velocity_);
  points_.resize(velocity_.size());
}

double LocalErrors::add_lag(std::span<const double> off, std::span<const double> v, long steps) {
  take(off, v);
  double fastest = 0.0;
  for (std::size_t p = 0; p < points_.size(); ++p) {
    const double speed = std::sqrt(dot(velocity_[p], velocity_[p]));
    if (speed == 0.0) continue;  // a NaN goes on
    points_[p].lag += static_cast<double>(steps) * std::abs(dot(error_[p], velocity_[p])) / speed;
    fastest = std::max(fastest, speed);
  }
  return fastest;
}

double LocalErrors::add_shift(std::span<const double> off, std::span<const double> v, double step,
                              long steps) {
  take(off, v);
  const double time = static_cast<double>(steps) * step;
  time_ += time;
  double fastest = 0.0;  // squared
  for (std::size_t p = 0; p < points_.size(); ++p) {
    Sums& sums = points_[p];
    const double squared = dot(error_[p], error_[p]);
    sums.lag += static_cast<double>(steps) * std::sqrt(squared);  // a NaN goes on
    sums.shift += time * squared / (step * step);
    fastest = std::max(fastest, dot(velocity_[p], velocity_[p]));
  }
  return std::sqrt(fastest);
}

void LocalErrors::add_speed(const SpeedError& error, std::span<const double> v, double step,
                            long steps, double braked) {
  take(error.now, v);
  point_vectors(scene_, length_, error.later, later_);
  const double time = static_cast<double>(steps) * step, kept = std::exp(-braked * time);
  samples_ = kept * samples_ + 1.0;
  steps_ = kept * steps_ + static_cast<double>(steps);
  for (std::size_t p = 0; p < points_.size(); ++p) {
    Sums& sums = points_[p];
    const double speed = std::sqrt(dot(velocity_[p], velocity_[p]));
    const double now = dot(error_[p], velocity_[p]), later = dot(later_[p], velocity_[p]);
    const double gain = now * later < 0.0 ? 0.0 : std::abs(later) < std::abs(now) ? later : now;
    sums.gain = kept * sums.gain + gain;
    sums.gain_squared = kept * sums.gain_squared + gain * gain;
    if (speed == 0.0) continue;
    const double mean = std::abs(sums.gain) / samples_;
    const double rms = std::sqrt(sums.gain_squared / samples_);
    const double gained =
        steps_ * std::max(0.0, mean - 2 * rms / std::sqrt(samples_)) + rms * std::sqrt(steps_);
    sums.way += time * (gained / speed > speed ? speed : gained / speed);
  }
}

double LocalErrors::sum() const {
  double largest = 0.0;
  for (const Sums& sums : points_) {
    const double total = sums.lag + sums.way + std::sqrt(time_ * sums.shift);
    // Not std::max, which would drop a NaN.
    if (!(total <= largest)) largest = std::isnan(total) ? HUGE_VAL : total;
  }
  return largest;
}

}  // namespace mbs
