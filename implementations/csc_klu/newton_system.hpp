// What the trapezoidal step asks of its linear system, in penalty or in saddle-point form.
#pragma once

#include <concepts>
#include <span>

namespace mbs::csc_klu {

/// A matrix, T of Eq. (5) or that of Eq. (12), with one right-hand side, which has n numbers or,
/// in saddle-point form, m more. It is made from and works on an Equations, which outlives it.
///
///   system.evaluate_residual();           // right(): that of Eq. (4) or (12), at q', v'
///   system.assemble();                    // values of the matrix at q', with C and K as they are
///   if (system.factorize()) system.solve();  // right() becomes the solution, Delta q the first n
///   system.take_multipliers();            // lambda by the solution, in saddle-point form
///   system.update_multipliers();          // lambda by Phi at the new q', in penalty form
///   system.start_again();                 // pivots as they were at first
///
/// For projections right() takes n numbers first; include_constraints(z) completes them by
/// -dt^2/4 alpha Phi_q^T z, Eqs. (6) and (15), or by -z, Eq. (13); z has m numbers.
/// Refined ones: include_geometric_stiffness(x) adds what Eq. (16) has in T_0 x; x has n numbers.
/// They have nu in saddle-point form: reset_reactions() makes it zero, include_reactions() puts its
/// share into right(), update_reactions() adds what a solution has of it.
template <class System>
concept NewtonSystem = requires(System system, std::span<const double> z) {
  system.evaluate_residual();
  system.assemble();
  { system.factorize() } -> std::same_as<bool>;
  system.solve();
  system.take_multipliers();
  system.update_multipliers();
  { System::kMultipliersNeedPhi } -> std::convertible_to<bool>;  // update_multipliers() needs it
  system.start_again();
  system.include_constraints(z);
  system.include_geometric_stiffness(z.data());
  system.reset_reactions();
  system.include_reactions();
  system.update_reactions();
  { system.right() } -> std::same_as<std::span<double>>;
};

}  // namespace mbs::csc_klu
