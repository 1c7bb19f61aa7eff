// The one interface that every implementation fulfils: set up once, then step.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include "mbs/model.hpp"
#include "mbs/phase_clock.hpp"

namespace mbs {

/// How a step advances the state: paper/README.md, "The step", and paper/other_schemes.md.
enum class Scheme {
  penalty,       ///< trapezoidal rule, T of Eq. (5)
  saddle_point,  ///< trapezoidal rule, Eq. (12)
  rattle,        ///< second order, one saddle-point factorization
  rattle4,       ///< fourth order, five stages of rattle
  rattle6,       ///< sixth order, seven stages of rattle
  multistep6,    ///< sixth order, symmetric multistep method, one factorization
};

/// Which projections end a step.
enum class Projections {
  none,      ///< v and a stay what Eq. (2) gave
  velocity,  ///< v is projected, a stays what Eq. (2) gave
  both,      ///< Eq. (6) for v, then for a
};

/// When lambda is updated; penalty form only.
enum class MultiplierUpdate {
  every_pass,
  converged,  ///< when Newton has converged at the present lambda
};

/// When the tangent is factorized; not for rattle, which does so once a stage.
enum class TangentReuse {
  none,  ///< every pass factorizes
  step,  ///< the first pass of a step does
  kept,  ///< kept over steps until convergence slows
};

/// What a step computes in.
enum class Precision {
  double_precision,
  single_precision,  ///< state, residual and factors are float; only time is double
  mixed,  ///< factors and solves in float; state and residual in double, projections refined
};

/// Settings of the time stepping, fixed for the lifetime of a Simulation. A variant serves what its
/// mbs::Serves says; the defaults are "The step" of the paper, which all serve, with every value of
/// `projections`. The program chooses a penalty or tolerance of 0 and checks the numbers before it
/// creates a simulation (step, penalty and tolerance are above 0, max_passes and projections_every
/// at least 1): an implementation need not.
struct StepSettings {
  double step = 1.25e-3;   ///< Delta t, s
  double penalty = 0.0;    ///< alpha, kg/(m^2 s^2); of linear rows, Phi in m, N/m
  double tolerance = 0.0;  ///< converged once max |Delta q| <= tolerance, m
  int max_passes = 20;     ///< passes a step at most; the last state is kept and stepping goes on
  Projections projections = Projections::both;
  int projections_every = 1;  ///< steps; the others keep what Eq. (2) gave
  Scheme scheme = Scheme::penalty;
  MultiplierUpdate multipliers = MultiplierUpdate::every_pass;
  TangentReuse tangent = TangentReuse::none;
  Precision precision = Precision::double_precision;
  bool geometric_stiffness = false;  ///< Eq. (16) in the tangent, which makes it exact
};

/// The full dynamic state at one instant.
struct State {
  std::vector<double> q;       ///< n, m
  std::vector<double> v;       ///< n, m/s
  std::vector<double> a;       ///< n, m/s^2
  std::vector<double> lambda;  ///< constraints(), lambda* of Eq. (1), N/m; of linear rows N
  double t = 0.0;              ///< s; get_state() writes it, do_get_state() need not
};

enum class StepStatus {
  converged,             ///< max |Delta q| <= tolerance within max_passes
  pass_limit,            ///< max_passes done; the state is the last iterate, projected as usual
  factorization_failed,  ///< the solver refused the tangent matrix; the state is not meaningful
};

struct StepOutcome {
  StepStatus status = StepStatus::converged;
  int passes = 0;           ///< passes begun, >= 1: one whose factorization failed counts
  int factorizations = -1;  ///< done in this step; -1: one a pass
};

/// What the first pass of a step computes, for `mbs check --ladder`. What is left empty reads "not
/// yet" there. Entry (i, j) of a matrix with n columns is at i n + j.
struct FirstPass {
  std::vector<double> q, v, a;  ///< n; q', v', a' as predicted, Eq. (2)
  std::vector<double> Phi;      ///< m; at q', Eqs. (7) and (8)
  std::vector<double> Phi_q;    ///< m x n
  std::vector<double> f;        ///< n, kg m; Eq. (3) as it stands there: with dt^2/4
  std::vector<double> T;        ///< n x n, kg; Eq. (5); what is above the diagonal is not looked at
};

/// Thrown by a factory when the implementation cannot simulate this model; `what()` says why.
class Unsupported : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// One simulation of one model. Construction (the factory in mbs::Variant) does everything that can
/// be done once: storage, patterns, symbolic analysis. step() allocates nothing where the library
/// allows that, and prints nothing.
///
///   auto simulation = variant.create(model, settings);
///   simulation->set_state(state);                   // checked once
///   StepOutcome outcome = simulation->step();       // Delta t further; the hot path
///   simulation->get_state(state);                   // sizes adapted
class Simulation {
 public:
  Simulation(const Model& model, const StepSettings& settings)
      : variables_(model.variables()), constraints_(model.constraints()), step_(settings.step) {}
  virtual ~Simulation() = default;
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;

  /// Starts from `state`. Throws std::invalid_argument on a wrong size or a non-finite number.
  void set_state(const State& state);

  /// Advances by one time step as paper/README.md, "The step", states it.
  [[nodiscard]] StepOutcome step() {
    ++steps_;
    return do_step();
  }

  /// Copies the current state out: q, v, a after the projections, lambda* and t.
  void get_state(State& state) const;

  /// Predicts a step from the present state and evaluates what its first pass does. Never timed;
  /// set_state() has to come before the next step. False: this implementation does not show it.
  [[nodiscard]] bool show_first_pass(FirstPass& pass) {
    ++steps_;
    return do_show_first_pass(pass);
  }

  /// The phase clock that step() marks; off unless the harness profiles.
  PhaseClock& phases() { return phases_; }

 protected:
  /// `state` has the right sizes, n and m, and finite numbers.
  virtual void do_set_state(const State& state) = 0;
  virtual StepOutcome do_step() = 0;
  /// `state` arrives with the right sizes.
  virtual void do_get_state(State& state) const = 0;

  /// Optional: for show_first_pass(), by the functions that do_step() calls. `pass` arrives empty.
  virtual bool do_show_first_pass(FirstPass& /*pass*/) { return false; }

  /// Within do_step() and do_show_first_pass(): the time at the end of this step, s. Only driven
  /// models need it.
  [[nodiscard]] double time() const { return start_ + static_cast<double>(steps_) * step_; }

  PhaseClock phases_;

 private:
  int variables_;
  int constraints_;
  double step_;         // s
  double start_ = 0.0;  // s; time of the last set_state()
  long steps_ = 0;      // since then
};

}  // namespace mbs
