// The step of paper/README.md on uBLAS vectors and compressed matrices.
#pragma once

#include "assembly.hpp"
#include "drivers.hpp"
#include "forces.hpp"
#include "matrices.hpp"
#include "mbs/simulation.hpp"
#include "points.hpp"
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
  /// Both projections, or that of v alone; points_ and Phi_q are still those of the last pass.
  void project();
  /// Solves Eq. (6) for the change of x, v or a, from the rate of Phi that comes with x in weight_.
  void correct(Vector& x);
  /// M + (step / 2) C + (step^2 / 4) K of the last pass; M itself where nothing adds to it.
  [[nodiscard]] const SparseMatrix& S() const { return forces_.has_stiffness() ? S_ : M_; }

  StepSettings settings_;
  double scale_;  // step^2 / 4
  Points points_;
  Constraints constraints_;
  Drivers drivers_;
  Forces forces_;
  SparseMatrix M_;
  SparseMatrix S_;                   // empty without C and K, as the next
  std::vector<double> mass_values_;  // those of M at the positions of S_
  TangentMatrices<Product> matrices_;
  KluSolver solver_;
  Vector Q_;
  Vector q_, v_, a_, lambda_;
  Vector Phi_, weight_;  // m
  Vector rhs_;           // n
  Vector next_;          // n, the next q
};

}  // namespace mbs::ublas_sparse
