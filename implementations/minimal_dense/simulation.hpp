// One simulation of the paper's step: what it keeps, and the parts that a step consists of.
#pragma once

#include "mbs/simulation.hpp"

namespace mbs::minimal_dense {

using Vector = std::vector<double>;

/// Names are the paper's symbols. All storage is made here, so that a step allocates nothing.
class LoopsSimulation final : public Simulation {
 public:
  LoopsSimulation(const Model& model, const StepSettings& settings);

 private:
  StepOutcome do_step() override;
  void do_set_state(const State& state) override { state_ = state; }
  void do_get_state(State& state) const override { state = state_; }
  bool do_show_first_pass(FirstPass& pass) override;

  // The parts of a step, in the order in which do_step() comes to them.
  void predict();
  void evaluate_constraints();
  void evaluate_residual();
  void assemble_tangent();
  [[nodiscard]] bool factorize_tangent();
  void solve(Vector& x);
  [[nodiscard]] bool correct();
  void project();
  void project(Vector& x);

  const Model& model_;
  const StepSettings settings_;
  const double dt_ = settings_.step, alpha_ = settings_.penalty;
  const long n_ = model_.variables(), m_ = model_.constraints();  // long: n_ * n_ is one, too
  // From predict() on, q_, v_ and a_ are the equations' q', v' and a'.
  State state_;
  Vector &q_ = state_.q, &v_ = state_.v, &a_ = state_.a, &lambda_ = state_.lambda;
  // Matrices are stored row by row, and all have rows of n: M_ij is M_[i * n_ + j].
  Vector M_ = Vector(n_ * n_);                        // both halves
  const std::span<const double> Q_ = model_.force();  // constant, as gravity is all there is
  Vector Phi_ = Vector(m_), Phi_q_ = Vector(m_ * n_);
  Vector T_ = Vector(n_ * n_), L_ = Vector(n_ * n_);  // lower halves; T = L L^T
  Vector Delta_q_ = Vector(n_);                       // -f, then the solution of Eq. (4)
  Vector rate_ = Vector(m_), change_ = Vector(n_);    // Eq. (6): of Phi or its rate; of v' or a'
};

}  // namespace mbs::minimal_dense
