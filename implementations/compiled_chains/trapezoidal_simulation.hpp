// The trapezoidal step on a chain (paper/README.md, "The step", "Saddle-point form"): who sweeps
// when.
#pragma once

#include <memory>
#include <utility>

#include "mbs/simulation.hpp"
#include "projection.hpp"
#include "saddle.hpp"

namespace mbs::compiled_chains {

/// Blocks, passes and projections of a form.
struct PenaltyForm {
  template <class V, class Rods>
  using Block = PassBlock<V, Rods>;
  template <class Store, bool kFirst>
  using Passes = Newton<Store, kFirst>;
  template <class Store>
  using Project = Projection<Store>;
};
struct SaddlePointForm {
  template <class V, class Rods>
  using Block = SaddleBlock<V, Rods>;
  template <class Store, bool kFirst>
  using Passes = SaddleNewton<Store, kFirst>;
  template <class Store>
  using Project = SaddleProjection<Store>;
};

template <class Form, template <class> class MassOf, class Rods>
class TrapezoidalSimulation final : public Simulation {
 public:
  TrapezoidalSimulation(const Model& model, const StepSettings& settings, Topology topology)
      : Simulation(model, settings),
        settings_(settings),
        topology_(std::move(topology)),
        units_(settings, topology_),
        tolerance_(2.0 * units_.length * settings.tolerance),
        chain_(static_cast<int>(topology_.places.size())) {
    chain_.set_constants(0, topology_, units_);
  }

 private:
  using Store = Storage<Pair, MassOf, Rods, Form::template Block>;
  using Project = typename Form::template Project<Store>;

  void do_set_state(const State& state) override {
    chain_.set_state(0, topology_, units_, state);
    until_projection_ = settings_.projections_every;
  }

  void do_get_state(State& state) const override { chain_.get(0, topology_, units_, state); }

  StepOutcome do_step() override {
    StepOutcome outcome{StepStatus::converged, 1};
    PassResult<Pair> result = Form::template Passes<Store, true>::pass(chain_);
    while (!converged(result)) {
      if (!is_factorized(result)) return {StepStatus::factorization_failed, outcome.passes};
      if (outcome.passes >= settings_.max_passes) {
        outcome.status = StepStatus::pass_limit;
        break;
      }
      result = Form::template Passes<Store, false>::pass(chain_);
      ++outcome.passes;
    }
    if (!is_factorized(result)) return {StepStatus::factorization_failed, outcome.passes};
    project();
    return outcome;
  }

  [[nodiscard]] bool converged(const PassResult<Pair>& result) const {
    return result.largest[0] <= tolerance_ && result.largest[1] <= tolerance_;
  }
  [[nodiscard]] static bool is_factorized(const PassResult<Pair>& result) {
    return result.least[0] > 0.0 && result.least[1] > 0.0;
  }

  void project() {
    const bool due = --until_projection_ == 0;
    if (due) until_projection_ = settings_.projections_every;
    if (!due || settings_.projections == Projections::none) return Project::settle(chain_);
    Project::velocity(chain_);
    if (settings_.projections == Projections::both) Project::acceleration(chain_);
  }

  StepSettings settings_;
  Topology topology_;
  Units units_;
  double tolerance_;
  Store chain_;
  int until_projection_ = 1;
};

template <template <class> class MassOf, class Rods>
using PenaltySimulation = TrapezoidalSimulation<PenaltyForm, MassOf, Rods>;
template <template <class> class MassOf, class Rods>
using SaddlePointSimulation = TrapezoidalSimulation<SaddlePointForm, MassOf, Rods>;

}  // namespace mbs::compiled_chains
