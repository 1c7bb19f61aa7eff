// Description of the folder's variants and their factory.
#include "mbs/implementation.hpp"

#include "lu_factors.hpp"
#include "operations.hpp"
#include "simulation.hpp"
#include "solver.hpp"

namespace mbs::csc_klu {

namespace {

constexpr Terms kTerms{
    Term::dots,    Term::bilinear, Term::linear,     Term::springs, Term::torsion_springs,
    Term::dampers, Term::couples,  Term::force_laws, Term::drivers, Term::mass_across_axes,
    Term::spatial};

constexpr Serves kServes = {.terms = kTerms,
                            .saddle_point = true,
                            .rattle = true,
                            .multistep = true,
                            .multiplier_update = true,
                            .tangent_reuse = true,
                            .projections_every = true};

/// Of variants that may leave the diagonal, where pivots of an indefinite matrix can be zero.
constexpr Serves with_geometric_stiffness(Serves serves) {
  serves.geometric_stiffness = true;
  return serves;
}

template <Order kOrder>
std::unique_ptr<Simulation> create_tried(const Model& model, const StepSettings& settings) {
  return create_ordered(model, settings, kOrder);
}

template <Order kOrder>
Variant tried(const char* name, const char* description) {
  return {.name = name,
          .description = description,
          .create = create_tried<kOrder>,
          .unsymmetric = true,
          .serves = {.terms = kTerms, .saddle_point = true},
          .tried_for = "refactor"};
}

}  // namespace

Implementation implementation() {
  return {
      .description = "hand-rolled compressed sparse columns, sparse LU with precomputed schedules",
      .library = "KLU",
      .version = klu_version(),
      .licence = "LGPL-2.1-or-later",
      .variants = {{.name = "refactor",
                    .description = "AMD ordering, tree lowered; pivots of the start, refactorized",
                    .create = create_simulation<Refactorization>,
                    .unsymmetric = true,
                    .serves = kServes,
                    .operations = create_operations},
                   {.name = "factor",
                    .description = "AMD ordering, tree lowered; pivots chosen anew in every pass",
                    .create = create_simulation<Factorization>,
                    .allocates = "klu_factor makes a new numeric object; KLU cannot reuse one",
                    .unsymmetric = true,
                    .serves = with_geometric_stiffness(kServes)},
                   {.name = "guarded",
                    .description = "refactorized until a solution's backward error asks for pivots",
                    .create = create_simulation<GuardedRefactorization>,
                    .unsymmetric = true,
                    .serves = with_geometric_stiffness(kServes)},
                   tried<Order::amd>("amd", "in AMD's order as it is"),
                   tried<Order::colamd>("colamd", "in the order of COLAMD")},
      .role = Role::paper,
  };
}

}  // namespace mbs::csc_klu
