// What the controls have in common: the reference, to be spoiled by those who derive from this.
#pragma once

#include <algorithm>

#include "mbs/simulation.hpp"
#include "reference/reference_simulation.hpp"

namespace mbs::test {

/// Passes everything on to the reference.
class WrappedReference : public Simulation {
 public:
  WrappedReference(const Model& model, const StepSettings& settings)
      : Simulation(model, settings), reference_(model, settings) {}

 protected:
  void do_set_state(const State& state) override { reference_.set_state(state); }
  StepOutcome do_step() override { return reference_.step(); }
  void do_get_state(State& state) const override { reference_.get_state(state); }

  /// The reference's state, rounded to double.
  [[nodiscard]] State state() const {
    State result;
    reference_.get_state(result);
    return result;
  }

  ReferenceSimulation reference_;
};

}  // namespace mbs::test
