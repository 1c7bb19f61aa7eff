// Right-hand sides and solutions of the penalty form.
#include "penalty_simulation.hpp"

#include <algorithm>

namespace mbs::csc_mumps {

namespace {

Triplets triplets_of(const ColumnPattern& pattern) {
  Triplets result{pattern.columns(), {}, {}};
  result.add(pattern);
  return result;
}

}  // namespace

PenaltySimulation::PenaltySimulation(const Model& model, const StepSettings& settings,
                                     Tuning tuning)
    : CscMumpsSimulation(model, settings, model.variables()),
      reaction_factor_(settings.step * settings.step / 4.0 * settings.penalty),
      tangent_(model, assembly_, settings),
      solver_(triplets_of(tangent_.pattern()), tangent_.values(), tuning),
      weights_(model.constraints(), 0.0) {}

bool PenaltySimulation::solve_newton() {
  phases_.enter(Phase::evaluation);
  const double* phi = assembly_.phi().data();
  for (std::size_t i = 0; i < weights_.size(); ++i) {
    weights_[i] = lambda_[i] + settings_.penalty * phi[i];
  }
  assembly_.balance(q_.data(), v_.data(), a_.data(), weights_.data(), x_.data());  // Eq. (3)
  phases_.enter(Phase::assembly);
  if (!tangent_.evaluate()) return false;
  phases_.enter(Phase::factorization);     // with the solution in it: one call does both
  return solver_.factorize_and_solve(x_);  // Eq. (4)
}

void PenaltySimulation::update_multipliers() {
  const double* phi = assembly_.phi().data();
  for (std::size_t i = 0; i < lambda_.size(); ++i) lambda_[i] += settings_.penalty * phi[i];
}

bool PenaltySimulation::solve_projection() {
  assembly_.react(reaction_factor_, rates_.data(), x_.data());
  phases_.enter(Phase::solve);
  return solver_.solve(x_);  // Eq. (6)
}

}  // namespace mbs::csc_mumps
