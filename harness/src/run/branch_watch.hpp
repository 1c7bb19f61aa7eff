// Finds motions that went on as another assembly of their mechanism.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mbs/simulation.hpp"
#include "model_math/closed_parts.hpp"
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
  /// Looks at the state at time t (s), later than the last one. Returns what happened if the motion
  /// jumped, empty if not.
  std::string look(double t, const State& state);
  /// Whether a part has other signs than at the last look; the same state may be asked any time.
  [[nodiscard]] bool is_across(double t, const State& state) const;

  /// The last state that is known to be on its branch, and the time.
  [[nodiscard]] const State& anchor() const { return anchor_; }
  [[nodiscard]] double anchor_time() const { return anchor_time_; }
  /// A step that is short enough for where it jumped, s; none if it is not known.
  [[nodiscard]] std::optional<double> step_needed() const { return step_needed_; }
  /// When, and where, an exact singular position was first passed, for people; empty if none was.
  [[nodiscard]] const std::string& passage() const { return passage_; }
  /// Where the constraints could not be followed; empty if nowhere.
  [[nodiscard]] const std::string& doubt() const { return doubt_; }

 private:
  struct Part {
    ConstraintBlock all;
    std::vector<ConstraintBlock> blocks;  // empty: one freedom
  };
  /// Where an entry of Phi_q goes: into the matrix of a determinant.
  struct Slot {
    int matrix = -1, place = 0;
    std::size_t entry = 0;
  };

  void add_part(ConstraintBlock all, std::vector<ConstraintBlock> blocks);
  [[nodiscard]] std::vector<int> signs(double t, const State& state) const;
  [[nodiscard]] std::string place_of(std::size_t matrix) const;
  void moor(double t, const State& state, std::vector<int> now);

  const Scene& scene_;
  double length_;  // m
  std::vector<Part> parts_;
  std::vector<std::size_t> part_of_;  // of each determinant
  std::vector<ConstraintBlock> matrices_;
  std::vector<Slot> slots_;
  State anchor_;
  double anchor_time_ = 0.0;       // s
  std::vector<int> anchor_signs_;  // -1, 1; 0: not known
  std::vector<double> tangent_;    // velocities as they were directed when signs were first known
  bool has_redundant_rows_ = false;
  std::optional<double> step_needed_;  // s
  std::string passage_, doubt_;
};

}  // namespace mbs
