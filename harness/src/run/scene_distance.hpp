// How far apart two vectors of coordinates, or of their derivatives, are: point by point.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "model_math/vector3.hpp"
#include "scene/scene.hpp"

namespace mbs {

/// What `entry` gives, by number, at a free point.
template <class Entry>
Vector3 entries_at(const Model& model, const Point& point, const Entry& entry) {
  const auto i = static_cast<std::size_t>(point.offset);
  return {entry(i), entry(i + 1), model.dimension() == 3 ? entry(i + 2) : 0.0};
}

/// Calls `take` with what each of `of` is at each point: the free ones, then the points of bodies
/// that are no coordinates; a unit vector counts as if it were `length` (m) long. `of` gives, by
/// number, entries of a difference of two vectors of coordinates, or of their derivatives: driven
/// points are where they are in both.
template <class Take, class... Of>
void for_each_point(const Scene& scene, double length, Take take, Of... of) {
  const Model& model = scene.model;
  const auto at = [&model](const Point& point, const auto& entry) {
    return entries_at(model, point, entry);
  };
  for (const Point& point : model.points()) {
    const double size = point.is_vector ? length : 1.0;
    if (!point.is_fixed()) take(size * at(point, of)...);
  }
  for (const Marker& marker : scene.elements.markers) {  // linear in the points
    const double size = marker.is_vector ? length : 1.0;
    const auto sum = [&](const auto& entry) {
      Vector3 x{};
      for (const Marker::Part& part : marker.parts) {
        const Point& point = model.points()[static_cast<std::size_t>(part.point)];
        if (!point.is_fixed()) x = x + multiply(part.matrix, at(point, entry));
      }
      return x;
    };
    take(size * sum(of)...);
  }
}

/// What errors of these points are small against, in their order, m: `length`, or that of their own
/// part if it is shorter (part_lengths()); `length` for unit vectors.
std::vector<double> lengths_of_points(const Scene& scene, double length);

/// Two points that a constraint of the model holds closer to each other than those lengths: each
/// may be off by little of them, and the direction from one to the other by much.
struct ShortLink {
  const DotConstraint* distance;
  double length;  ///< m, at the start
};
std::vector<ShortLink> short_links(const Model& model, double length);

/// As for_each_point(): what each of `of` is at one end less what it is at the other.
template <class Take, class... Of>
void for_each_link(const Model& model, std::span<const ShortLink> links, Take take, Of... of) {
  const auto at = [&model](int index, const auto& entry) {
    const Point& point = model.points()[static_cast<std::size_t>(index)];
    return point.is_fixed() ? Vector3{} : entries_at(model, point, entry);
  };
  for (const ShortLink& link : links) {
    take((at(link.distance->a, of) - at(link.distance->b, of))...);
  }
}

}  // namespace mbs
