// The step of paper/README.md on uBLAS vectors and compressed matrices.
#pragma once

#include "assembly.hpp"
#include "matrices.hpp"
#include "mbs/simulation.hpp"
#include "solver.hpp"

namespace mbs::ublas_sparse {

/// Every matrix operation is the library's, redone from scratch in every pass. `Product`, the
/// rank-k update, is ExpressionProduct or AxpyProduct.
template <class Product>
class UblasSimulation final : public Simulation {
 public:
  /// Throws Unsupported if KLU cannot analyse the tangent matrix of `model`.
  UblasSimulation(const Model& model, const StepSettings& settings);

 private:
  void do_set_state(const State& state) override;
  StepOutcome do_step() override;
  void do_get_state(State& state) const override;

  void predict();
  /// Phi_q, and -f of Eq. (3) into rhs_, at the current position.
  void evaluate_residual();
  void assemble_tangent();
  /// Applies the solved correction in rhs_; true if it is within the tolerance.
  [[nodiscard]] bool update();
  void project();

  StepSettings settings_;
  double scale_;  // step^2 / 4
  Constraints constraints_;
  TangentMatrices<Product> matrices_;
  KluSolver solver_;
  Vector Q_;
  Vector q_, v_, a_, lambda_;
  Vector Phi_, weight_;  // m
  Vector rhs_, next_;    // n
};

}  // namespace mbs::ublas_sparse
