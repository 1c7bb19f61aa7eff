// The simulation that does nothing; in a file of its own so that its step stays a real virtual
// call.
#include "bench/null_variant.hpp"

#include "registry/factory.hpp"

namespace mbs {
namespace {

class NullSimulation final : public Simulation {
 public:
  explicit NullSimulation(const Model& model) : Simulation(model, StepSettings{}) {}

 protected:
  void do_set_state(const State& state) override { state_ = state; }
  StepOutcome do_step() override { return {StepStatus::converged, 1}; }
  void do_get_state(State& state) const override { state = state_; }

 private:
  State state_;
};

}  // namespace

const Variant& null_variant() {
  static const Variant variant{
      .name = "null",
      .description = "does nothing: the harness's own overhead",
      .create = [](const Model& model, const StepSettings&) -> std::unique_ptr<Simulation> {
        return std::make_unique<NullSimulation>(model);
      },
      .serves = {all_terms(), true, true, true, true, true, true, true, true, true}};
  return variant;
}

}  // namespace mbs
