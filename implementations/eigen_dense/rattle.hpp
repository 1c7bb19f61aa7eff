// RATTLE of order two, four and six.
#pragma once

#include <algorithm>
#include <vector>

#include "mbs/model.hpp"
#include "mbs/simulation.hpp"
#include "rattle_stage.hpp"
#include "stage_lengths.hpp"

namespace mbs::eigen_dense {

/// "RATTLE" of paper/README.md. Between steps R(q) of the state is factorized.
template <typename Scalar>
class Rattle final : public mbs::Simulation {
 public:
  Rattle(const Model& model, const StepSettings& settings)
      : mbs::Simulation(model, settings),
        lengths_(stage_lengths<Scalar>(settings)),
        stage_(model, settings, phases_) {}

 private:
  void do_set_state(const State& state) override { stage_.set(state); }
  void do_get_state(State& state) const override { stage_.motion().get(state); }

  StepOutcome do_step() override {
    StepOutcome outcome{StepStatus::converged, 0, 0};
    for (const Scalar h : lengths_) {
      if (stage_.advance(h, outcome)) continue;
      outcome.status = StepStatus::factorization_failed;
      outcome.passes = std::max(outcome.passes, 1);
      break;
    }
    return outcome;
  }

  std::vector<Scalar> lengths_;  ///< of the stages, s
  RattleStage<Scalar> stage_;
};

}  // namespace mbs::eigen_dense
