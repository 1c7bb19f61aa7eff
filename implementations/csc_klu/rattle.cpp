// RATTLE of second, fourth and sixth order: stages of one saddle-point factorization each.
#include "rattle.hpp"

#include "rattle_step.hpp"

namespace mbs::csc_klu {
namespace {

template <int dim, TangentSolver Solver>
class RattleSimulation final : public Simulation {
 public:
  RattleSimulation(const Model& model, const StepSettings& settings)
      : Simulation(model, settings), rattle_(model, settings, phases_) {
    rattle_.start();
  }

 private:
  void do_set_state(const State& state) override { rattle_.restart(state); }
  void do_get_state(State& state) const override { rattle_.equations().get_state(state); }
  StepOutcome do_step() override { return rattle_.advance(); }

  RattleStep<dim, Solver> rattle_;
};

}  // namespace

template <TangentSolver Solver>
std::unique_ptr<Simulation> create_rattle(const Model& model, const StepSettings& settings) {
  if (model.dimension() == 2) return std::make_unique<RattleSimulation<2, Solver>>(model, settings);
  return std::make_unique<RattleSimulation<3, Solver>>(model, settings);
}

template std::unique_ptr<Simulation> create_rattle<Refactorization>(const Model&,
                                                                    const StepSettings&);
template std::unique_ptr<Simulation> create_rattle<Factorization>(const Model&,
                                                                  const StepSettings&);
template std::unique_ptr<Simulation> create_rattle<GuardedRefactorization>(const Model&,
                                                                           const StepSettings&);

}  // namespace mbs::csc_klu
