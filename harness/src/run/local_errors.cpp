// One pass over the points.
#include "run/local_errors.hpp"

#include <algorithm>
#include <cmath>

namespace mbs {

namespace {

auto entries_of(std::span<const double> x) {
  return [x](std::size_t i) { return x[i]; };
}

}  // namespace

LocalErrors::LocalErrors(const Scene& scene, double length, const std::vector<bool>& passes_on)
    : scene_(scene), length_(length), links_(short_links(scene.model, length)) {
  if (passes_on.empty()) return;
  const auto points = scene.model.points();
  const auto is_of_such = [&](const Point& point) {
    return !point.is_fixed() && passes_on[static_cast<std::size_t>(point.offset)];
  };
  const std::vector<double> lengths = lengths_of_points(scene, length);
  auto its = lengths.begin();
  for (const Point& point : points) {
    if (!point.is_fixed()) points_.push_back({&point.name, *its++, is_of_such(point)});
  }
  const auto is_number_of_such = [&](int point) {
    return is_of_such(points[static_cast<std::size_t>(point)]);
  };
  for (const Marker& marker : scene.elements.markers) {
    points_.push_back({&marker.name, *its++,
                       std::ranges::any_of(marker.parts, is_number_of_such, &Marker::Part::point)});
  }
  for (const ShortLink& link : links_) {
    points_.push_back({&link.distance->name, link.length,
                       is_number_of_such(link.distance->a) || is_number_of_such(link.distance->b)});
  }
}

double LocalErrors::add(std::span<const double> off, std::span<const double> v, double step,
                        long steps) {
  const double more = static_cast<double>(steps), time = more * step;
  time_ += time;
  const double shifted = time / (step * step);
  double fastest = 0.0;  // squared
  auto point = points_.begin();
  const auto add = [&](const Vector3& error, const Vector3& velocity) {
    Sums& sums = *point++;
    const double squared = dot(velocity, velocity);
    fastest = std::max(fastest, squared);
    if (squared > sums.fastest) {
      if (sums.fastest > 0.0) sums.lag *= std::sqrt(squared / sums.fastest);
      sums.fastest = squared;
    }
    if (sums.passes_on) {  // errors across the way too; a NaN goes on
      const double whole = dot(error, error);
      sums.lag += more * std::sqrt(whole);
      sums.shift += shifted * whole;
    } else if (squared != 0.0) {
      sums.lag += more * std::abs(dot(error, velocity)) / std::sqrt(squared);
    }
  };
  for_each_point(scene_, length_, add, entries_of(off), entries_of(v));
  const double result = std::sqrt(fastest);  // without links
  for_each_link(scene_.model, links_, add, entries_of(off), entries_of(v));
  return result;
}

void LocalErrors::add_speed(const SpeedError& error, std::span<const double> v, double step,
                            long steps, double braked) {
  const double time = static_cast<double>(steps) * step;
  const double kept = braked > 0.0 ? std::exp(-braked * time) : 1.0;
  samples_ = kept * samples_ + 1.0;
  steps_ = kept * steps_ + static_cast<double>(steps);
  auto point = points_.begin();
  const auto add = [&](const Vector3& off, const Vector3& off_later, const Vector3& velocity) {
    Sums& sums = *point++;
    const double speed = std::sqrt(dot(velocity, velocity));
    const double now = dot(off, velocity), later = dot(off_later, velocity);
    const double gain = now * later < 0.0 ? 0.0 : std::abs(later) < std::abs(now) ? later : now;
    sums.gain = kept * sums.gain + gain;
    sums.gain_squared = kept * sums.gain_squared + gain * gain;
    if (speed == 0.0) return;
    const double mean = std::abs(sums.gain) / samples_;
    const double rms = std::sqrt(sums.gain_squared / samples_);
    const double gained =
        steps_ * std::max(0.0, mean - 2 * rms / std::sqrt(samples_)) + rms * std::sqrt(steps_);
    sums.way += time * (gained / speed > speed ? speed : gained / speed);
  };
  const auto now = entries_of(error.now), later = entries_of(error.later), way = entries_of(v);
  for_each_point(scene_, length_, add, now, later, way);
  for_each_link(scene_.model, links_, add, now, later, way);
}

LocalErrors::Worst LocalErrors::worst() const {
  Worst result;
  for (const Sums& sums : points_) {
    double sum = sums.lag + sums.way + std::sqrt(time_ * sums.shift);
    if (std::isnan(sum)) sum = HUGE_VAL;
    if (sum / sums.length > result.share) result = {sum, sum / sums.length, *sums.name};
  }
  return result;
}

}  // namespace mbs
