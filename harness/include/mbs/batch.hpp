// Many simulations of one pattern at once, for implementations that advance them side by side.
#pragma once

#include <span>
#include <vector>

#include "mbs/simulation.hpp"

namespace mbs {

/// Whether two models differ in values only: the same dimension, points (fixed, driven, vectors,
/// offsets), constraints, springs, couples and drivers between the same points, and positions in M;
/// stiffnesses, dampings and entries of B that are zero in one are zero in the other.
bool have_same_shape(const Model& a, const Model& b);

/// Whether all but penalty and tolerance is the same.
bool have_same_method(const StepSettings& a, const StepSettings& b);

/// Simulations ("lanes") of models of the same shape, with settings of the same method.
///
///   auto batch = variant.create_batch(models, settings);
///   batch->set_state(lane, state);          // every lane, all at the same time t
///   batch->step(outcomes);                  // all lanes Delta t further; the hot path
///   batch->get_state(lane, state);
///   batch->retire(lane);                    // one that is lost or at its end
///
/// A lane's motion, its number of passes and its outcome are those of a Simulation of its model
/// with its settings, up to rounding, whatever the other lanes do: one that fails, becomes NaN or
/// needs more passes does not disturb them.
class BatchSimulation {
 public:
  /// Throws std::invalid_argument unless there is a lane, each has settings, and all have the same
  /// shape and method.
  BatchSimulation(std::span<const Model* const> models, std::span<const StepSettings> settings);
  virtual ~BatchSimulation() = default;
  BatchSimulation(const BatchSimulation&) = delete;
  BatchSimulation& operator=(const BatchSimulation&) = delete;

  [[nodiscard]] int lanes() const { return static_cast<int>(lanes_.size()); }

  /// As Simulation::set_state(), of one lane. The first one after a step begins anew: every lane,
  /// retired ones too, is to be set or retired before the next step.
  void set_state(int lane, const State& state);
  void get_state(int lane, State& state) const;

  /// A step of every lane that is not retired. `outcomes` has lanes() entries, in their order;
  /// those of retired lanes mean nothing. Throws std::logic_error if a lane was not set, or not to
  /// the same time as the others.
  void step(std::span<StepOutcome> outcomes);

  /// The lane takes no part from now on, until it is set again; its state means nothing.
  void retire(int lane);
  [[nodiscard]] bool is_retired(int lane) const;

 protected:
  virtual void do_set_state(int lane, const State& state) = 0;
  /// `state` arrives with the right sizes.
  virtual void do_get_state(int lane, State& state) const = 0;
  /// Outcomes of retired lanes may be anything.
  virtual void do_step(std::span<StepOutcome> outcomes) = 0;
  /// For implementations that would spend time on the lane otherwise.
  virtual void do_retire(int /*lane*/) {}

  /// Within do_step(): the time at the end of this step, s. Only driven models need it.
  [[nodiscard]] double time() const { return start_ + static_cast<double>(steps_) * step_; }

 private:
  enum class Lane { unset, running, retired };
  void require_ready();

  std::vector<Lane> lanes_;
  int variables_;
  int constraints_;
  double step_;                 // s
  std::vector<double> starts_;  // s, of each lane
  double start_ = 0.0;          // s, of all
  long steps_ = 0;              // since then
};

}  // namespace mbs
