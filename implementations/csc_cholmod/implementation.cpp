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

constexpr const char* kAllocates = "cholmod_super_numeric allocates its workspace in every call";

constexpr Terms kTerms{
    Term::dots,    Term::bilinear, Term::linear,     Term::springs, Term::torsion_springs,
    Term::dampers, Term::couples,  Term::force_laws, Term::drivers, Term::mass_across_axes,
    Term::spatial};

constexpr Method kSimplicial{Factorization::simplicial}, kSupernodal{Factorization::supernodal};

template <Method kMethod>
std::unique_ptr<Simulation> create(const Model& model, const StepSettings& settings) {
  if (settings.scheme == Scheme::saddle_point) {
    return std::make_unique<CholmodSimulation<SaddleForm>>(model, settings, kMethod);
  }
  return std::make_unique<CholmodSimulation<PenaltyForm>>(model, settings, kMethod);
}

std::unique_ptr<Operations> create_operations(const Model& model) {
  return std::make_unique<CscOperations>(model);
}

/// The penalty form alone.
template <Tuning kTuning>
Variant tried_supernodal(const char* name, const char* description) {
  return {.name = name,
          .description = description,
          .create = create<Method{Factorization::supernodal, kTuning}>,
          .allocates = kAllocates,
          .serves = {.terms = kTerms},
          .tried_for = "supernodal"};
}

}  // namespace

Implementation implementation() {
  return {
      .description = "compressed sparse columns of one half, Cholesky in AMD order",
      .library = "CHOLMOD",
      .version = library_version(),
      .licence = "LGPL-2.1-or-later AND GPL-2.0-or-later",
      .variants = {{.name = "simplicial",
                    .description = "entry by entry, LDL', without BLAS (LGPL-2.1-or-later itself, "
                                   "in a library that is GPL as a whole)",
                    .create = create<kSimplicial>,
                    .serves = {.terms = kTerms, .saddle_point = true},
                    .operations = create_operations},
                   {.name = "supernodal",
                    .description = "blocks of columns, LL', over BLAS (GPL-2.0-or-later)",
                    .create = create<kSupernodal>,
                    .allocates = kAllocates,
                    .serves = {.terms = kTerms}},
                   {.name = "simplicial_amd",
                    .description = "in AMD's order as it is",
                    .create = create<Method{Factorization::simplicial, Tuning::amd}>,
                    .serves = {.terms = kTerms, .saddle_point = true},
                    .tried_for = "simplicial"},
                   tried_supernodal<Tuning::amd>("supernodal_amd",
                                                 "AMD's order, supernodes of up to 16 columns"),
                   tried_supernodal<Tuning::metis>(
                       "supernodal_metis", "order of METIS, supernodes of up to 16 columns"),
                   tried_supernodal<Tuning::trees>("supernodal_trees",
                                                   "lowest trees, supernodes of up to 16 columns"),
                   tried_supernodal<Tuning::defaults>(
                       "supernodal_defaults", "AMD's order, supernodes as CHOLMOD has them")},
      .role = Role::paper,
  };
}

}  // namespace mbs::csc_cholmod
