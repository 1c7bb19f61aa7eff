// One simulation of the step: what it keeps, and the parts that a step consists of.
#pragma once

#include "assembly.hpp"
#include "constraints.hpp"
#include "elements.hpp"
#include "mass.hpp"
#include "mbs/simulation.hpp"
#include "sums.hpp"

namespace mbs::csc_ldl {

using Vector = std::vector<double>;

/// Names are the paper's symbols. The state is in the order of elimination, lambda in that of
/// Constraints; all storage is made here.
class LdlSimulation final : public Simulation {
 public:
  LdlSimulation(const Model& model, const StepSettings& settings, Order order);

 private:
  StepOutcome do_step() override;
  void do_set_state(const State& state) override;
  void do_get_state(State& state) const override;
  bool do_show_first_pass(FirstPass& pass) override;

  // The parts of a step, in the order in which do_step() comes to them.
  void drive();
  void predict();
  void evaluate_constraints();
  void evaluate_residual();
  void assemble();
  [[nodiscard]] bool factorize();
  void solve();
  [[nodiscard]] bool correct();
  void project();
  void update_multipliers(const Vector& change, double factor);

  [[nodiscard]] const double* of_all_points(const Vector& x, Vector& all);
  void project(Vector& x, const double* all);

  const Model& model_;
  const StepSettings settings_;
  const double dt_ = settings_.step, alpha_ = settings_.penalty;
  const bool saddle_point_ = settings_.scheme == Scheme::saddle_point;
  const Numbering numbering_;
  const Coordinates at_;
  const int n_ = at_.variables, m_ = model_.constraints();

  Mass mass_;
  Constraints constraints_;
  Elements elements_;
  Assembly assembly_;

  // q, v and a have fixed points behind the n variables; there v and a are zero.
  Vector q_ = Vector(at_.total), v_ = q_, a_ = q_, lambda_ = Vector(m_);
  Vector minus_Q_ = Vector(n_);       // its part that is no element's
  Vector row_parts_, element_parts_;  // of forces
  Sums row_forces_, element_forces_;  // by variable
  Vector top_ = Vector(n_);           // a right-hand side, then its solution
  Vector bottom_ = Vector(m_);        // of rows, saddle-point form
  Vector g_ = Vector(m_);             // what Phi_q^T is multiplied with
  const bool are_driven_;             // points, values, masses or factors
  Vector all_v_, all_a_;              // with driven points' behind the n variables, if driven
  Vector force_;                      // the model's, in the state's order
};

}  // namespace mbs::csc_ldl
