// Describes this folder to the harness.
#include "mbs/implementation.hpp"

#include <memory>

#include "operations.hpp"
#include "penalty_form.hpp"
#include "saddle_form.hpp"
#include "simulation.hpp"
#include "solver.hpp"

namespace mbs::csc_cholmod {
namespace {

constexpr Terms kTerms{
    Term::dots,    Term::bilinear, Term::linear,     Term::springs, Term::torsion_springs,
    Term::dampers, Term::couples,  Term::force_laws, Term::drivers, Term::mass_across_axes,
    Term::spatial};

template <Factorization kFactorization>
std::unique_ptr<Simulation> create(const Model& model, const StepSettings& settings) {
  if (settings.scheme == Scheme::saddle_point) {
    return std::make_unique<CholmodSimulation<SaddleForm>>(model, settings, kFactorization);
  }
  return std::make_unique<CholmodSimulation<PenaltyForm>>(model, settings, kFactorization);
}

std::unique_ptr<Operations> create_operations(const Model& model) {
  return std::make_unique<CscOperations>(model);
}

}  // namespace

Implementation implementation() {
  return {
      .description = "compressed sparse columns of one half, Cholesky in AMD order",
      .library = "CHOLMOD",
      .version = library_version(),
      .licence = "LGPL-2.1-or-later AND GPL-2.0-or-later",
      .variants = {{.name = "simplicial",
                    .description = "entry by entry, LDL', without BLAS (LGPL-2.1-or-later)",
                    .create = create<Factorization::simplicial>,
                    .serves = {.terms = kTerms, .saddle_point = true},
                    .operations = create_operations},
                   {.name = "supernodal",
                    .description = "blocks of columns, LL', over BLAS (GPL-2.0-or-later)",
                    .create = create<Factorization::supernodal>,
                    .allocates = "cholmod_super_numeric allocates its workspace in every call",
                    .serves = {.terms = kTerms}}},
      .role = Role::paper,
  };
}

}  // namespace mbs::csc_cholmod
