// The linear systems of a pass: the penalty form, Eq. (4), and the saddle-point form, Eq. (12).
#pragma once

#include <algorithm>

#include "constraints.hpp"
#include "forces.hpp"
#include "mbs/simulation.hpp"
#include "schedule.hpp"

namespace mbs::hybrid_dense {

/// The tangent T of Eq. (5).
template <int D, class Solver>
class PenaltySystem {
 public:
  static constexpr bool kSaddle = false;

  PenaltySystem(const Model& model, const Slots&, const Constraints<D>& constraints,
                Forces<D>& forces, const StepSettings& settings)
      : forces_(forces),
        s_(settings.step * settings.step / 4 * settings.penalty),
        solver_(model.variables()),
        schedule_(model, constraints.firsts(), constraints.slots(), forces.tangent_entries(),
                  position()) {
    Schedule::write_mass(model, position(), solver_.matrix());
    forces.schedule(position());
  }

  void assemble(const double* Phi_q) {
    schedule_.assemble(s_, Phi_q, solver_.matrix());
    if (forces_.in_tangent()) forces_.add_tangent(solver_.matrix());
  }
  [[nodiscard]] bool factorize() { return solver_.factorize(); }
  void solve(double* x) const { solver_.solve(x); }

  double* matrix() { return solver_.matrix(); }
  Schedule::Position position() {
    return [this](long i, long j) { return solver_.position(i, j); };
  }

 private:
  const Forces<D>& forces_;
  const double s_;
  Solver solver_;
  Schedule schedule_;
};

/// Eq. (12) by its Schur complement, which is positive definite as T_0 is:
///
///   S = epsilon + Phi_q T_0^-1 Phi_q^T,   S mu = Phi_q T_0^-1 r_1 - r_2,   T_0 x = r_1 - Phi_q^T
///   mu
///
/// This is the factorization L D L^T of the quasi-definite matrix in the order (q, mu), whose
/// pivots are those of T_0 and then those of -S; no other order is safer, as T_0 holds no
/// 1/epsilon. Without springs T_0 = M is inverted once; with springs every row of Phi_q is solved
/// for. Solves with T_0 become products with what there is of its inverse.
template <int D, class Solver>
class SaddleSystem {
 public:
  static constexpr bool kSaddle = true;

  SaddleSystem(const Model& model, const Slots& slots, const Constraints<D>& constraints,
               Forces<D>& forces, const StepSettings& settings);

  /// Phi_q is read until the last solve with it.
  void assemble(const double* Phi_q);
  [[nodiscard]] bool factorize();
  /// x is r_1, y is r_2 when they arrive, then the solution.
  void solve(double* x, double* y);
  /// The same with r_1 = 0, whatever x is when it arrives.
  void solve_constraints(double* x, double* y);

 private:
  void invert();
  void solve_rows();
  void multiply_rows();
  void solve_schur(double* x, double* y);

  const Constraints<D>& constraints_;
  const Forces<D>& forces_;
  const long n_, m_, total_;
  const double epsilon_;
  Solver T_0_, S_;
  Schedule schedule_;
  bool regular_ = true;
  const double* Phi_q_ = nullptr;
  // T_0^-1, row by row; rows of fixed points are zero. With springs only Phi_q T_0^-1,
  // or Phi_q L^-T of T_0 = L L^T.
  Array inverse_;
  Array product_;  // Phi_q T_0^-1: kWidth rows at a time, column by column
  Array z_, z_y_;
};

}  // namespace mbs::hybrid_dense
