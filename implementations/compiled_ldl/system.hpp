// The equations of a model on its program: state, residual, matrix, solves.
#pragma once

#include <type_traits>

#include "constraints.hpp"
#include "drivers.hpp"
#include "forces.hpp"
#include "fronts.hpp"
#include "mass.hpp"
#include "mbs/simulation.hpp"
#include "panels.hpp"

namespace mbs::compiled_ldl {

/// S: numbers of the state; F: of the matrix and its factors.
template <typename S, typename F, int D>
class System {
 public:
  System(std::span<const Model* const> models, std::span<const StepSettings> settings);

  void put(int lane, const State& state);
  void get(int lane, State& state) const;

  void drive(double t) { drivers.drive(t, q.data(), v.data(), constraints, force.data()); }
  void evaluate() { constraints.evaluate(q.data(), phi.data()); }

  void evaluate_and_update() {
    constraints.evaluate_and_update(q.data(), phi.data(), alpha, lambda.data());
  }

  /// y = −f of Eq. (3), or the right-hand side of Eq. (12), in two parts: without the forces of the
  /// constraints, and these. assemble() belongs between them.
  void begin_residual();
  void finish_residual();
  /// The matrix of Eq. (5), (12) or (14), at the last evaluate() and the last forces.
  void assemble();
  /// The matrix of Eq. (5), in the other lanes the one that they had.
  void assemble_where(const LaneMask& mask);
  /// y = solution; false if a pivot was not accepted.
  bool factorize_and_solve();
  void solve();

  /// y = T₀ x, or M x for RATTLE.
  void product(const S* x);
  /// y −= (Δt²/4) α Φqᵀ t, or the multipliers' rows = −t.
  void constrain(const S* t);
  /// The multipliers' rows of y = −Φ(q), in the saddle-point forms; gradients stay.
  void constrain_values();
  /// λ or ν += factor times the multipliers' rows of y, which become zero.
  void take_multipliers(S* multipliers, const S& factor);
  /// q' += y, v' += to_v y, a' += y/h; max|y| as below.
  S apply(const S& to_v);
  /// max|y|, NaN if there is one.
  [[nodiscard]] S largest() const;

  Program program;
  Rows rows;
  bool saddle, rattle, curved;
  S alpha, epsilon, h;  // h = Δt²/4
  Constraints<S, D> constraints;
  Drivers<S, D> drivers;
  Forces<S, D> forces;
  Mass<S, D> mass;
  std::conditional_t<kLanesOf<F> == 1, Panels<F>, Fronts<F>> fronts;
  Array<S> q, v, a, force, y;   // extent
  Array<S> lambda, phi, terms;  // constraints

 private:
  static constexpr bool kSame = std::is_same_v<S, F>;
  void fill_constants();
  S scale_down();
  void scale_up(const S& scale);

  Array<F> rounded_;  // y in units of its largest entry
};

}  // namespace mbs::compiled_ldl

#include "system_setup.hpp"
#include "system_solve.hpp"
