// Controls that come back from their step with something wrong.
#include "controls/wrong_results.hpp"

#include <limits>

#include "controls/wrapped_reference.hpp"

namespace mbs::test {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

class ReturnsAtOnce final : public WrappedReference {
  using WrappedReference::WrappedReference;
  StepOutcome do_step() override { return {StepStatus::converged, 1}; }
};

class NanAfter100 final : public WrappedReference {
  using WrappedReference::WrappedReference;
  void do_set_state(const State& state) override {
    steps_ = 0;
    WrappedReference::do_set_state(state);
  }
  StepOutcome do_step() override {
    ++steps_;
    return WrappedReference::do_step();
  }
  void do_get_state(State& state) const override {
    WrappedReference::do_get_state(state);
    if (steps_ <= 100) return;
    for (auto* values : {&state.q, &state.v, &state.a, &state.lambda}) {
      std::ranges::fill(*values, kNaN);
    }
  }
  int steps_ = 0;
};

/// A NaN in one number only.
class NanVelocity final : public WrappedReference {
  using WrappedReference::WrappedReference;
  void do_get_state(State& state) const override {
    WrappedReference::do_get_state(state);
    state.v.back() = kNaN;
  }
};

class EmptyState final : public WrappedReference {
  using WrappedReference::WrappedReference;
  void do_get_state(State& state) const override { state = {}; }
};

class SinglePrecision final : public WrappedReference {
  using WrappedReference::WrappedReference;
  StepOutcome do_step() override {
    const StepOutcome outcome = WrappedReference::do_step();
    State rounded = state();
    for (auto* values : {&rounded.q, &rounded.v, &rounded.a, &rounded.lambda}) {
      for (double& value : *values) value = static_cast<float>(value);
    }
    reference_.set_state(rounded);
    return outcome;
  }
};

/// The step is right, and then lambda is what it was before.
class WrongLambda final : public WrappedReference {
  using WrappedReference::WrappedReference;
  StepOutcome do_step() override {
    const State before = state();
    const StepOutcome outcome = WrappedReference::do_step();
    State after = state();
    after.lambda = before.lambda;
    reference_.set_state(after);
    return outcome;
  }
};

class PassCount final : public WrappedReference {
  using WrappedReference::WrappedReference;
  StepOutcome do_step() override {
    const StepOutcome outcome = WrappedReference::do_step();
    return {outcome.status, outcome.passes + 1};
  }
};

/// Never admits the pass limit.
class AlwaysConverged final : public WrappedReference {
  using WrappedReference::WrappedReference;
  StepOutcome do_step() override {
    return {StepStatus::converged, WrappedReference::do_step().passes};
  }
};

class FactorizationFailed final : public WrappedReference {
  using WrappedReference::WrappedReference;
  StepOutcome do_step() override { return {StepStatus::factorization_failed, 1}; }
};

/// Right at first, and after one step that is not.
class LateJump final : public WrappedReference {
  using WrappedReference::WrappedReference;
  void do_set_state(const State& state) override {
    steps_ = 0;
    WrappedReference::do_set_state(state);
  }
  StepOutcome do_step() override {
    const StepOutcome outcome = WrappedReference::do_step();
    if (++steps_ == 500) {
      State moved = state();
      for (double& velocity : moved.v) velocity *= 1 + 1e-5;
      reference_.set_state(moved);
    }
    return outcome;
  }
  int steps_ = 0;
};

ModelData against_gravity(const Model& model) {
  ModelData data;
  data.dimension = model.dimension();
  data.points.assign(model.points().begin(), model.points().end());
  data.dot_constraints.assign(model.dot_constraints().begin(), model.dot_constraints().end());
  data.linear_constraints.assign(model.linear_constraints().begin(),
                                 model.linear_constraints().end());
  data.mass.assign(model.mass().begin(), model.mass().end());
  for (const double component : model.force()) data.force.push_back(-component);
  data.initial_velocity.assign(model.initial_velocity().begin(), model.initial_velocity().end());
  return data;
}

/// Keeps the model it changed alive, which must therefore be constructed first.
struct OwnModel {
  Model model;
};

class GravitySign final : OwnModel, public WrappedReference {
 public:
  GravitySign(const Model& model, const StepSettings& settings)
      : OwnModel{Model(against_gravity(model))}, WrappedReference(OwnModel::model, settings) {}
};

template <class Control>
std::unique_ptr<Simulation> create_wrong(const Model& model, const StepSettings& settings) {
  return std::make_unique<Control>(model, settings);
}

}  // namespace

std::vector<Variant> wrong_results() {
  return {
      {.name = "reference",
       .description = "no defect",
       .create = create_wrong<WrappedReference>,
       .serves = {{}, true, true, true, true, true, true, true, true}},
      {"returns_at_once", "step() computes nothing and says converged",
       create_wrong<ReturnsAtOnce>},
      {"nan_after_100", "the state is NaN after 100 steps", create_wrong<NanAfter100>},
      {"nan_velocity", "one velocity is NaN", create_wrong<NanVelocity>},
      {"empty_state", "the state comes back empty", create_wrong<EmptyState>},
      {"gravity_sign", "gravity points up", create_wrong<GravitySign>},
      {"single_precision", "the state is rounded to float after each step",
       create_wrong<SinglePrecision>},
      {"wrong_lambda", "lambda is not updated", create_wrong<WrongLambda>},
      {"late_jump", "velocities change by 1e-5 of themselves in step 500", create_wrong<LateJump>},
      {"pass_count", "claims one pass too many", create_wrong<PassCount>},
      {"always_converged", "never admits the pass limit", create_wrong<AlwaysConverged>},
      {"factorization_failed", "refuses every tangent matrix", create_wrong<FactorizationFailed>},
  };
}

}  // namespace mbs::test
