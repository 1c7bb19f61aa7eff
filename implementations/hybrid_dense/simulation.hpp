// The step of paper/README.md and its saddle-point form; one class for both.
#pragma once

#include <memory>

#include "constraints.hpp"
#include "forces.hpp"
#include "mass.hpp"
#include "mbs/simulation.hpp"
#include "solver.hpp"
#include "systems.hpp"

namespace mbs::hybrid_dense {

/// Names are the paper's symbols. q_, v_, a_ and right-hand sides have room for fixed points
/// (Slots).
template <int D, class System>
class HybridSimulation final : public Simulation {
 public:
  HybridSimulation(const Model& model, const StepSettings& settings);

 private:
  StepOutcome do_step() override;
  void do_set_state(const State& state) override;
  void do_get_state(State& state) const override;
  bool do_show_first_pass(FirstPass& pass) override;

  void drive();
  void predict();
  void evaluate_constraints();
  void evaluate_residual();
  [[nodiscard]] bool correct();
  void project();
  void subtract_projection(Array& result);

  const Model& model_;
  const StepSettings settings_;
  const double dt_ = settings_.step, alpha_ = settings_.penalty;
  const long n_ = model_.variables(), m_ = model_.constraints();
  const Slots slots_{model_};
  const bool driven_;

  Constraints<D> constraints_{model_, slots_};
  Forces<D> forces_{model_, slots_, dt_};
  Mass mass_{model_, slots_};
  System system_{model_, slots_, constraints_, forces_, settings_};

  Array q_{slots_.total}, v_{slots_.total}, a_{slots_.total};
  Array lambda_{padded(m_)}, Phi_{padded(m_)}, y_{padded(m_)};
  Array Phi_q_{constraints_.entries()};
  Array Q_{padded(n_)};          // gravity, less what driven mass takes
  Array Delta_q_{slots_.total};  // right-hand sides, then solutions
};

}  // namespace mbs::hybrid_dense
