// What this folder offers: description and factories.
#include "mbs/implementation.hpp"

#include <stdexcept>

#include "adjustable_simulation.hpp"
#include "rattle_simulation.hpp"
#include "rounded_solver.hpp"
#include "simulation.hpp"

namespace mbs::eigen_sparse {
namespace {

std::string versions() {
  const auto dotted = [](int a, int b, int c) {
    return std::to_string(a) + "." + std::to_string(b) + "." + std::to_string(c);
  };
  return "Eigen " + dotted(EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION) +
         ", SuperLU " + superlu_version();
}

/// "The step" as it is where nothing else is asked for.
template <class Solver, class Rounded, template <class> class Form>
std::unique_ptr<Simulation> create_in(const Model& model, const StepSettings& settings) {
  if (settings.precision == Precision::mixed) {
    return std::make_unique<AdjustableSimulation<Form<Rounded>>>(model, settings);
  }
  if (settings.multipliers != MultiplierUpdate::every_pass ||
      settings.tangent != TangentReuse::none || settings.projections_every != 1) {
    return std::make_unique<AdjustableSimulation<Form<Solver>>>(model, settings);
  }
  return std::make_unique<SparseSimulation<Form<Solver>>>(model, settings);
}

template <template <class> class Solver>
std::unique_ptr<Simulation> create(const Model& model, const StepSettings& settings) {
  switch (settings.scheme) {
    case Scheme::penalty:
      return create_in<Solver<double>, RoundedSolver<Solver>, PenaltyForm>(model, settings);
    case Scheme::saddle_point:
      return create_in<Solver<double>, RoundedSolver<Solver>, SaddleForm>(model, settings);
    case Scheme::rattle:
    case Scheme::rattle4:
    case Scheme::rattle6:
      return std::make_unique<RattleSimulation<Solver<double>>>(model, settings);
    case Scheme::multistep6:
      break;
  }
  throw std::logic_error("multistep6 is not among what eigen_sparse serves");
}

constexpr Terms kTerms{
    Term::dots,    Term::bilinear, Term::linear,  Term::springs,          Term::torsion_springs,
    Term::dampers, Term::couples,  Term::drivers, Term::mass_across_axes, Term::spatial};

constexpr Serves kServes{.terms = kTerms,
                         .saddle_point = true,
                         .rattle = true,
                         .multiplier_update = true,
                         .tangent_reuse = true,
                         .projections_every = true,
                         .mixed_precision = true};

/// The step as it is where nothing else is asked for, in the penalty form.
template <class Solver>
std::unique_ptr<Simulation> create_default(const Model& model, const StepSettings& settings) {
  return std::make_unique<SparseSimulation<PenaltyForm<Solver>>>(model, settings);
}

/// `Solver` with a setting that was tried for `base`.
template <class Solver>
Variant tried(const char* name, const char* description, const Variant& base) {
  return {.name = name,
          .description = description,
          .create = create_default<Solver>,
          .allocates = base.allocates,
          .unsymmetric = base.unsymmetric,
          .serves = {.terms = kTerms},
          .tried_for = base.name};
}

}  // namespace

Implementation implementation() {
  const Variant superlu{
      .name = "superlu",
      .description = "supernodal LU with diagonal pivots; ordering, tree and storage reused",
      .create = create<SuperluSolver>,
      .allocates = "SuperLU's dgstrf and sp_dtrsv allocate their work space in every call",
      .unsymmetric = true,
      .serves = kServes};
  const Variant ldlt{.name = "ldlt",
                     .description = "Eigen's up-looking LDL^T; AMD ordering, tree lowered",
                     .create = create<SimplicialSolver>,
                     .serves = kServes};
  return {
      .description =
          "Eigen's sparse matrices, values refreshed in place; SuperLU or simplicial LDL^T",
      .library = "Eigen, SuperLU",
      .version = versions(),
      .licence = "MPL-2.0 AND BSD-3-Clause",
      .variants = {superlu,
                   ldlt,
#ifdef MBS_PARDISO
                   {.name = "pardiso",
                    .description = "MKL's PARDISO, LL^T, in its own order (ISSL)",
                    .create = create_default<PardisoSolver>,
                    .allocates = "Eigen copies the matrix and right-hand sides for PARDISO",
                    .serves = {.terms = kTerms}},
#endif
                   tried<TunedSuperlu<double, Tuning::amd>>("superlu_amd", "AMD's order", superlu),
                   tried<TunedSuperlu<double, Tuning::colamd>>(
                       "superlu_colamd", "order of COLAMD, the library's default", superlu),
                   tried<TunedSuperlu<double, Tuning::panels>>(
                       "superlu_panels", "panels and relaxed supernodes of the library's sizes",
                       superlu),
                   tried<TunedSimplicial<double, Tuning::amd>>("ldlt_amd",
                                                               "in AMD's order as it is", ldlt)},
      .role = Role::paper};
}

}  // namespace mbs::eigen_sparse
