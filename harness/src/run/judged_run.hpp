// One run as it is judged step by step, whoever does the steps: a simulation, or a lane of a batch.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "run/branch_watch.hpp"
#include "run/force_errors.hpp"
#include "run/half_step_run.hpp"
#include "run/local_errors.hpp"
#include "run/local_half_steps.hpp"
#include "run/power_balance.hpp"
#include "run/quarter_turn.hpp"
#include "run/run.hpp"
#include "run/sampled_time.hpp"
#include "run/step_again.hpp"

namespace mbs {

/// Takes what each step gives, looks at the state where the settings ask for it, and arrives at the
/// typed outcome.
///
///   JudgedRun judged(scene, settings, initial_state(scene.model), observer);
///   judged.begin(access);
///   while (!judged.is_over()) judged.take(simulation.step());
///   RunSummary summary = judged.finish();
class JudgedRun {
 public:
  /// What does the steps, as far as a judge needs it.
  struct Access {
    std::function<void(State&)> get_state;
    /// A simulation that can be set back, to do steps of this run again: the same, or one like it.
    std::function<Simulation&()> again;
    /// Makes simulations like it, with other settings.
    StepAgain::Create create;
    /// Whose equations it solves: the scene's, or these with their constraints scaled.
    const Model* model = nullptr;
    /// Whether again() gives another simulation than the one that does the steps.
    bool is_again_another = false;
  };

  /// `scene` must outlive this, and so must the model of begin().
  JudgedRun(const Scene& scene, const RunSettings& settings, State start, Observer observer);

  /// The simulation is ready and at the start. Throws Unsupported if what runs beside it is.
  void begin(Access access);
  /// The simulation has done a step.
  void take(const StepOutcome& outcome);
  /// At the end, or lost.
  [[nodiscard]] bool is_over() const { return is_over_; }
  /// Within a catch block: what the exception says of this run. Passes std::bad_alloc on, and
  /// UsageError, which an observer throws that cannot write.
  void take_exception();

  /// The outcome, but for the times of steps and set-up.
  [[nodiscard]] RunSummary finish();

 private:
  static inline const std::string kNotFactorized = "the tangent matrix could not be factorized";
  /// A step that is to be judged, and the one before it.
  struct Sample {
    long step;
    State before, after;
  };
  /// The last step at which the solution was not lost.
  struct LastGood {
    long step;
    State state;
    Judge::Figures figures;
  };

  [[nodiscard]] double time(long step) const;
  [[nodiscard]] long uneven_after(long step, long interval) const;
  [[nodiscard]] long judged_after(long step, const State& state);
  void count(const StepOutcome& outcome);
  void copy(State& state);
  void judge_samples();
  void judge(Sample& sample);
  void look(const State& present);
  [[nodiscard]] bool is_unusual(const StepOutcome& outcome) const;
  [[nodiscard]] long looked_after(const State& present) const;
  [[nodiscard]] long first_across(long step);
  bool locate_loss(const std::string& reason, long step);
  void catch_up();
  void lose(RunStatus status, std::string reason, std::optional<double> t);
  void lose(const Judge& judge, const std::string& reason, long step);
  /// What may be behind a loss with this scheme.
  [[nodiscard]] std::string hint() const;
  void add_local_errors(const Sample& sample);
  /// Whether drivers lead points about, other than all at one constant velocity.
  [[nodiscard]] bool is_led() const { return is_driven_ && !judge_.judges_energy(); }
  void add_led_errors(const Sample& sample);
  void add_speed_error(const Sample& sample);
  [[nodiscard]] bool is_in_turn(long step) const;
  void balance_energy(const Sample& sample);
  void conclude();
  void note_beyond(long step);
  /// Whether the run so far is beyond AccurateBounds.
  [[nodiscard]] bool is_beyond() const;
  /// Of the point whose local errors add up to most of its length.
  [[nodiscard]] double local_share() const;
  [[nodiscard]] std::string beyond_estimates() const;

  const Scene& scene_;
  RunSettings settings_;
  Observer observer_;
  Access access_;
  long steps_;            // of the whole run
  long interval_;         // between two judgements
  long next_judged_ = 0;  // step
  long next_look_;        // step; beyond the last where there is nothing to look at
  long last_look_ = 0;
  State state_;  // the last one that was looked at
  std::vector<Sample> samples_;
  std::size_t waiting_ = 0;       // of these: copied, to be judged together
  std::optional<long> set_back_;  // step at which the simulation was left by a false alarm
  Judge judge_;
  LastGood good_;
  BranchWatch watch_;
  QuarterTurn quarter_turn_;
  std::optional<PowerBalance> balance_;  // where energy is not conserved
  long judgements_ = 0, balanced_ = 0;   // balanced_: step, of errors where drivers lead, too
  std::optional<StepAgain> again_;       // of the trapezoidal forms
  long done_again_ = 0;                  // step
  LocalErrors local_errors_;
  ForceErrors forces_;
  std::vector<double> off_;             // n, m
  long next_compared_ = 0;              // step, of forces
  long next_noted_ = 2;                 // step; half the step is compared first after one
  std::optional<double> beyond_since_;  // s, by when it was found beyond AccurateBounds
  std::optional<HalfStepRun> half_;
  std::optional<LocalHalfSteps> local_half_;
  bool adds_local_errors_;    // nothing better tells, and constraints do not fix all
  bool is_driven_;            // something is
  bool has_figures_ = false;  // of a state beyond the start
  bool is_over_ = false;
  SampledTime copying_, judging_, looking_;
  double doing_again_ = 0.0;  // s, steps of StepAgain
  double aside_ = 0.0;        // s, of a judgement: what is counted by itself, or is no judging
  RunSummary summary_;
};

}  // namespace mbs
