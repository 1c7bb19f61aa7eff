// Judges states from outside: constraint violation, energy, distance from the exact solution.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "exact/four_bar_exact.hpp"
#include "mbs/simulation.hpp"
#include "model_math/even_carriage.hpp"
#include "run/constraint_values.hpp"
#include "run/part_energies.hpp"
#include "scene/scene.hpp"

namespace mbs {

/// Beyond these a run has lost its solution. They are wide on purpose: they separate a motion that
/// is inaccurate from one that means nothing.
struct RunBounds {
  double position_error = 0.1;         ///< m, where an exact solution is known
  double energy_drift = 0.1;           ///< of the energy scale, see Judge; if energy is conserved
  double constraint_violation = 1e-2;  ///< |Phi| relative to the squared length it constrains
  double tilt =
      1e-2;  ///< |cosine| between the axis of a torsion spring or torque law and what it turns
  double pass_limit_share = 0.05;  ///< of the steps; a few near singular positions are normal
};

/// Within these a run is `ok`, between them and RunBounds it is `degraded`: on the N-four-bar a
/// hundredth of a rod's length.
struct AccurateBounds {
  double position_error = 1e-2;  ///< m, where an exact solution is known
  /// Of lengths_of_points(), where the error is estimated: HalfStepRun.
  double estimated_error = 1e-2;
  /// Of lengths_of_points(): LocalErrors, of which errors are usually one to twelve times.
  double local_error = 3e-3;
  double energy_drift = 1e-2;  ///< as RunBounds
  double constraint_violation = 1e-4;
  double force = 5e-2;  ///< of its largest value, of a force or acceleration asked for: ForceErrors
};

/// What errors are small against where the exact motion is not known, m: the length of the part
/// that turns fastest, at most the extent. (Points of other parts have their own if it is shorter:
/// lengths_of_points().)
double judged_length(const Model& model);

/// Figures of one state, and the worst so far; NaN never passes for small.
class Judge {
 public:
  /// `scene` must outlive the judge; `initial` is the state at time `start` (s).
  Judge(const Scene& scene, const State& initial, double start);

  /// Judges the state at time t. Returns the reason if the solution is lost, empty if not.
  std::string judge(double t, const State& state);

  /// Adds the way by which `time` (s) with as much too much or too little energy as the last judged
  /// state has is ahead or behind, of the fastest point, which has `speed` (m/s).
  void add_time(double time, double speed);
  /// Adds what `steps` steps like the last one leave in the balance of a scene that does not
  /// conserve energy: change of energy less `work`, and the size of that, J each.
  void add_balance(double excess, double work, long steps);
  /// Largest |sum of the excess| over the run, over the larger of the largest kinetic energy and
  /// the work so far; none without add_balance().
  [[nodiscard]] std::optional<double> imbalance_max() const { return so_far_.imbalance; }
  /// The farthest that add_time() found the motion ahead or behind, m.
  [[nodiscard]] double ahead_max() const;
  /// The velocity of `judged`, the last state, in the frame of feet that are carried along; n, m/s.
  [[nodiscard]] const std::vector<double>& velocity(const State& judged) const {
    return carriage_ ? moved_v_ : judged.v;
  }
  /// judged_length() of the scene, m.
  [[nodiscard]] double length() const { return length_; }
  [[nodiscard]] bool knows_exact_motion() const { return exact_.has_value(); }
  /// Whether energy is conserved, and energy_drift_max() known.
  [[nodiscard]] bool judges_energy() const { return conservative_; }

  /// The worst so far and what the next state is judged by, without the rest of the judge.
  struct Figures {
    std::vector<double> twists;  // as torsions() has them, continued; rad
    EnergyFigures energy;        // of the whole; its scale alone where that does not conserve it
    std::optional<double> position_error;
    double violation = 0.0;           // m^2, m
    double relative_violation = 0.0;  // as RunBounds ...
    int most_violated = 0;            // ... of this row, where it is beyond AccurateBounds
    bool off_branch = false;
    double excess = 0.0, work = 0.0;  // J
    std::optional<double> imbalance;
    std::vector<EnergyFigures> parts;
  };
  [[nodiscard]] const Figures& figures() const { return so_far_; }
  /// Judges on from where another judge of the same run had these.
  void take_back(const Figures& figures) { so_far_ = figures; }

  /// Marks every figure as lost: infinite.
  void spoil();

  /// Whether the state that judge() refused satisfies the constraints and conserves energy, but is
  /// on another branch of the motion than the exact one.
  [[nodiscard]] bool off_branch() const { return so_far_.off_branch; }
  /// The worst figures that are beyond AccurateBounds, for people; empty if none is.
  [[nodiscard]] std::string degradation() const;
  /// Whether one is.
  [[nodiscard]] bool is_degraded() const;

  /// Largest distance of a point from the exact motion, m; none if no exact solution is known.
  [[nodiscard]] std::optional<double> position_error_max() const { return so_far_.position_error; }
  /// Largest |E - E_0| over the energy scale: the largest kinetic energy so far, but at least a
  /// thousandth of the work that the applied forces do over the scene's extent and of what springs
  /// hold at the start, and that of a millionth of the extent a second, which is rest; where feet
  /// are carried along evenly, in their frame. Dimensionless; none if the model is not
  /// conservative.
  [[nodiscard]] std::optional<double> energy_drift_max() const;
  /// Largest |Phi_k|, m^2 (m for linear constraints).
  [[nodiscard]] double constraint_violation_max() const { return so_far_.violation; }

 private:
  /// A worst figure beside its bound, and how people call it.
  struct Bounded {
    double value, bound;
    const char* what;
    std::string (Judge::*where)() const = nullptr;
    [[nodiscard]] bool is_beyond() const { return !(value <= bound); }
  };
  [[nodiscard]] std::array<Bounded, 5> bounded() const;
  [[nodiscard]] std::string drifting_part() const;
  [[nodiscard]] std::string violated_row() const;
  std::string judge_energy(double t, const State& state);
  /// Of the constraint that is violated most in the last judged state.
  [[nodiscard]] int most_violated_row() const;
  /// Largest drift of a part; 0 where there are none that are judged by themselves.
  [[nodiscard]] double part_drift() const;
  /// Into moved_, in the frame of feet that are carried along.
  void move_with_feet(double t, const State& state);
  /// Whether Eqs. (11) and (18) still mean what they say: across the axis, and less than half a
  /// turn from s = 0.
  std::string judge_torsion(double t, const State& state);
  const Scene* scene_;  // a pointer, so that judges can be copied
  RunBounds bounds_;
  std::optional<FourBarExact> exact_;
  ConstraintValues constraints_;
  std::vector<double> phi_;
  std::vector<double> phi_scale_;
  bool conservative_;
  std::optional<EvenCarriage> carriage_;
  std::optional<PartEnergies> parts_;      // where the whole is no guide, or would hide one
  std::vector<double> frame_velocity_;     // n, m/s: 0 where feet rest
  std::vector<double> moved_q_, moved_v_;  // n, where they are carried
  double length_ = 1.0;                    // m
  Figures so_far_;
};

}  // namespace mbs
