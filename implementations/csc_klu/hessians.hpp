// The second derivatives of Phi, which are constants: found once from the model.
#pragma once

#include <vector>

#include "jacobian_pattern.hpp"
#include "mbs/model.hpp"
#include "mbs/simulation.hpp"

namespace mbs::csc_klu {

/// One entry that is not zero of the Hessian of a quadratic constraint, Eq. (16).
struct HessianEntry {
  int constraint;  ///< in the order of JacobianPattern
  int row, col;    ///< coordinates
  double value;
};

/// All of them, constraint by constraint, both triangles. Example, planar, the distance from a
/// fixed point to B: {0, 0, 0, 2}, {0, 1, 1, 2}.
template <int dim>
[[nodiscard]] std::vector<HessianEntry> hessian_entries(const Model& model,
                                                        const JacobianPattern<dim>& jacobian);

/// The same where `settings` ask for geometric stiffness, else nothing.
template <int dim>
[[nodiscard]] std::vector<HessianEntry> needed_hessians(const Model& model,
                                                        const StepSettings& settings,
                                                        const JacobianPattern<dim>& jacobian) {
  if (!settings.geometric_stiffness) return {};
  return hessian_entries(model, jacobian);
}

}  // namespace mbs::csc_klu
