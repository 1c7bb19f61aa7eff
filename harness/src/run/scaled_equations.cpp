// Scales a copy of the model's data; translates multipliers on the way in and out.
#include "run/scaled_equations.hpp"

#include <cmath>
#include <utility>

#include "registry/factory.hpp"
#include "run/settings.hpp"

namespace mbs {
namespace {

/// The power of two nearest to sqrt(mean / s), for each of the diagonal entries s.
std::vector<double> power_of_two_factors(const Model& model) {
  const double mean = mean_constraint_eigenvalue(model);
  std::vector<double> result;
  for (const double s : constraint_diagonal(model)) {
    result.push_back(s > 0.0 ? std::exp2(std::round(std::log2(mean / s) / 2)) : 1.0);
  }
  for (const DrivenValue& driven : model.driven_values()) {
    result[static_cast<std::size_t>(driven.constraint)] = 1.0;
  }
  return result;
}

BilinearConstraint as_bilinear(const DotConstraint& c) {
  BilinearConstraint result{c.a, c.b, c.c, c.d, {}, c.value, c.name};
  for (std::size_t i = 0; i < 3; ++i) result.B[i][i] = 1.0;
  return result;
}

std::unique_ptr<Model> scaled(const Model& model, const std::vector<double>& factors) {
  ModelData data = model.data();
  std::vector<BilinearConstraint> bilinear;
  for (const DotConstraint& c : data.dot_constraints) bilinear.push_back(as_bilinear(c));
  bilinear.insert(bilinear.end(), data.bilinear_constraints.begin(),
                  data.bilinear_constraints.end());
  auto factor = factors.begin();
  for (BilinearConstraint& c : bilinear) {
    for (auto& row : c.B) {
      for (double& entry : row) entry *= *factor;
    }
    c.value *= *factor++;
  }
  for (LinearConstraint& c : data.linear_constraints) {
    for (auto& term : c.terms) term.coefficient *= *factor;
    c.value *= *factor++;
  }
  data.dot_constraints.clear();
  data.bilinear_constraints = std::move(bilinear);
  return std::make_unique<Model>(std::move(data));
}

class ScaledSimulation final : public Simulation {
 public:
  ScaledSimulation(const Model& original, const StepSettings& settings,
                   const std::vector<double>& factors, std::unique_ptr<Simulation> simulation)
      : Simulation(original, settings), factors_(factors), simulation_(std::move(simulation)) {}

 protected:
  void do_set_state(const State& state) override {
    State inner = state;
    for (std::size_t k = 0; k < factors_.size(); ++k) inner.lambda[k] /= factors_[k];
    simulation_->set_state(inner);
  }
  StepOutcome do_step() override { return simulation_->step(); }
  void do_get_state(State& state) const override {
    simulation_->get_state(state);
    for (std::size_t k = 0; k < factors_.size(); ++k) state.lambda[k] *= factors_[k];
  }

 private:
  const std::vector<double>& factors_;
  std::unique_ptr<Simulation> simulation_;
};

}  // namespace

ScaledEquations::ScaledEquations(const Model& model)
    : factors_(power_of_two_factors(model)), model_(scaled(model, factors_)) {}

std::unique_ptr<Simulation> ScaledEquations::create(const Variant& variant, const Model& original,
                                                    const StepSettings& settings) const {
  return std::make_unique<ScaledSimulation>(original, settings, factors_,
                                            create_simulation(variant, *model_, settings));
}

}  // namespace mbs
