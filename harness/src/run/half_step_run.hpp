// The same simulation with half the step, run beside it to estimate its error.
#pragma once

#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "run/scene_distance.hpp"
#include "run/step_again.hpp"
#include "scene/scene.hpp"

namespace mbs {

/// 2^p / (2^p - 1) with the order p of `scheme`.
double richardson_factor(Scheme scheme);

/// Richardson's estimate: what a scheme of order p leaves is 2^p / (2^p - 1) times the difference
/// to half the step, where both steps are short enough for its order to show. No exact solution is
/// needed.
class HalfStepRun {
 public:
  /// `create` makes simulations like the one beside it, `half` is at half its step, unit vectors
  /// count as `length` (m) long. `scene` must outlive this.
  HalfStepRun(const Scene& scene, const StepAgain::Create& create, const StepSettings& half,
              const State& initial, double length);

  /// Two half steps.
  void advance();

  /// Takes the whole-step simulation's state at the same time.
  void compare(const State& whole);

  /// Largest estimated distance of a point so far, m; infinite once the half-step simulation is
  /// lost, not a number before compare().
  [[nodiscard]] double position_error_max() const { return error_; }
  /// The same over the length of each point, lengths_of_points(), or of a ShortLink.
  [[nodiscard]] double share_max() const { return share_; }
  /// Name of that point or link.
  [[nodiscard]] std::string farthest_off() const;

 private:
  const Scene& scene_;
  std::unique_ptr<Simulation> simulation_;
  State state_;
  double length_;                // of unit vectors, m
  std::vector<double> lengths_;  // of points, m
  std::vector<ShortLink> links_;
  double factor_;
  double error_ = std::numeric_limits<double>::quiet_NaN();  // nothing was compared
  double share_ = error_;
  std::size_t worst_ = 0;  // whose share_ it is: a point, else a link
};

}  // namespace mbs
