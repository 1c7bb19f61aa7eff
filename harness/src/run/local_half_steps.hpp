// What one step leaves, by two steps of half its length from the same state.
#pragma once

#include <memory>

#include "registry/registry.hpp"
#include "scene/scene.hpp"

namespace mbs {

/// For schemes whose local error has no formula as short as the trapezoidal rule's: that of order p
/// leaves 2^p / (2^p - 1) times the difference to two half steps.
class LocalHalfSteps {
 public:
  /// `settings` are those of the whole step, unit vectors count as `length` (m) long. `scene` must
  /// outlive this.
  LocalHalfSteps(const Scene& scene, const Variant& variant, const StepSettings& settings,
                 double length);

  /// Largest distance of a point, m; `after` is one step after `before`.
  [[nodiscard]] double error(const State& before, const State& after);

 private:
  const Scene& scene_;
  std::unique_ptr<Simulation> simulation_;
  State state_;
  double length_;  // of unit vectors, m
  double factor_;
};

}  // namespace mbs
