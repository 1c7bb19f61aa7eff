// Finds motions that went on as another assembly of their mechanism.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mbs/simulation.hpp"
#include "model_math/block_jacobian.hpp"
#include "model_math/closed_parts.hpp"
#include "model_math/follow_curve.hpp"
#include "scene/scene.hpp"

namespace mbs {

/// Looks at the signs of determinants that a motion cannot change without a jump; where one did,
/// follows the constraints from the last state whose signs were right (follow_curve()), which tells
/// a jump from a passage of a singular position.
///
///   BranchWatch watch(scene, start, judged_length(scene.model), true);
///   if (watch.is_needed()) { const std::string jump = watch.look(t, state); }
class BranchWatch {
 public:
  /// `scene` must outlive this; `start` is the state at time 0, `length` (m) what errors are small
  /// against. Not `wanted`: there is nothing to look at.
  BranchWatch(const Scene& scene, const State& start, double length, bool wanted);

  /// Whether there is a part to look at.
  [[nodiscard]] bool is_needed() const { return !parts_.empty(); }
  /// The shortest of what the parts' errors are small against, m.
  [[nodiscard]] double length() const { return length_; }
  /// Of the whole mechanism; 0 if nothing is wanted.
  [[nodiscard]] int freedoms() const { return freedoms_; }
  /// ClosedParts::passes_on; empty if nothing is wanted.
  [[nodiscard]] const std::vector<bool>& passes_on() const { return passes_on_; }
  /// Looks at the state at time t (s), later than the last one. Returns what happened if the motion
  /// jumped, empty if not.
  std::string look(double t, const State& state);
  /// Whether a part has other signs than at the last look; the same state may be asked any time.
  [[nodiscard]] bool is_across(double t, const State& state);

  /// The last state that is known to be on its branch, and the time.
  [[nodiscard]] const State& anchor() const { return anchor_; }
  [[nodiscard]] double anchor_time() const { return anchor_time_; }
  /// A step that is short enough for where it jumped, s; none if it is not known.
  [[nodiscard]] std::optional<double> step_needed() const { return step_needed_; }
  /// When, and where, an exact singular position was first passed, for people; empty if none was.
  [[nodiscard]] const std::string& passage() const { return passage_; }
  /// Where the constraints could not be followed; empty if nowhere.
  [[nodiscard]] const std::string& doubt() const { return doubt_.empty() ? pending_ : doubt_; }

 private:
  /// What is followed where a determinant changes its sign.
  struct Part {
    ConstraintBlock all;
    std::vector<ConstraintBlock> blocks;  // empty: one freedom
    bool is_carried = false;              // one freedom, beside drivers
    double length = 1.0;                  // m, the least of lengths_of_points()
  };
  void find_lengths();
  /// Into now_: -1, 1; 0: not known.
  void find_signs(double t, const State& state);
  [[nodiscard]] std::string place_of(std::size_t matrix) const;
  [[nodiscard]] double turned(const ConstraintBlock& block, const State& state) const;
  [[nodiscard]] bool is_carried(std::size_t matrix) const { return parts_[matrix].is_carried; }
  void find_tangents(const State& start);
  [[nodiscard]] std::optional<FollowedCurve> follow(const Part& part, double t,
                                                    const State& state) const;
  void moor(double t, const State& state);

  const Scene& scene_;
  double length_;                          // m
  std::vector<Part> parts_;                // of each determinant
  std::optional<BlockJacobian> matrices_;  // whose determinants these are
  std::vector<double> eliminated_;         // of one, to work in
  std::vector<double> turned_;             // of each with one freedom, as of find_signs()
  State anchor_;
  double anchor_time_ = 0.0;             // s
  std::vector<int> anchor_signs_, now_;  // as of find_signs()
  // Velocities as they were directed when signs were first known; of a part that is carried, the
  // direction that its constraints leave, unit length.
  std::vector<double> tangent_;
  std::vector<bool> has_redundant_rows_;  // as ClosedParts
  int freedoms_ = 0;
  std::vector<bool> passes_on_;
  int uncertain_ = 0;                      // looks since the anchor that could not tell
  std::optional<double> step_needed_;      // s
  std::string passage_, doubt_, pending_;  // pending_: a doubt that later looks may settle
};

}  // namespace mbs
