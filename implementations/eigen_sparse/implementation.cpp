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

/// With a setting that was tried; "the step" alone.
template <class Solver, Tuning kTuning>
std::unique_ptr<Simulation> create_tuned(const Model& model, const StepSettings& settings) {
  if (settings.scheme == Scheme::saddle_point) {
    return std::make_unique<SparseSimulation<SaddleForm<Solver>>>(model, settings, kTuning);
  }
  return std::make_unique<SparseSimulation<PenaltyForm<Solver>>>(model, settings, kTuning);
}

Variant tried(const char* name, const char* description, decltype(Variant::create) create,
              const Variant& base) {
  return {.name = name,
          .description = description,
          .create = create,
          .allocates = base.allocates,
          .unsymmetric = base.unsymmetric,
          .serves = {.terms = kTerms, .saddle_point = true},
          .tried_for = base.name};
}

#ifdef MBS_PARDISO
std::unique_ptr<Simulation> create_pardiso(const Model& model, const StepSettings& settings) {
  return std::make_unique<SparseSimulation<PenaltyForm<PardisoSolver>>>(model, settings);
}
#endif

}  // namespace

Implementation implementation() {
  const Variant superlu{
      .name = "superlu",
      .description =
          "supernodal LU with diagonal pivots; MMD, AMD or model's order; storage reused",
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
                    .create = create_pardiso,
                    .allocates = "Eigen copies the matrix and right-hand sides for PARDISO",
                    .serves = {.terms = kTerms}},
#endif
                   tried("superlu_amd", "always in AMD's order",
                         create_tuned<SuperluSolver<double>, Tuning::amd>, superlu),
                   tried("superlu_mmd", "always in that of minimum degree on T + T^T",
                         create_tuned<SuperluSolver<double>, Tuning::mmd>, superlu),
                   tried("superlu_colamd", "order of COLAMD, the library's default",
                         create_tuned<SuperluSolver<double>, Tuning::colamd>, superlu),
                   tried("superlu_metis", "order of METIS",
                         create_tuned<SuperluSolver<double>, Tuning::metis>, superlu),
                   tried("superlu_trees", "the order of ldlt, lowest trees",
                         create_tuned<SuperluSolver<double>, Tuning::trees>, superlu),
                   tried("superlu_panels", "panels and relaxed supernodes of the library's sizes",
                         create_tuned<SuperluSolver<double>, Tuning::panels>, superlu),
                   tried("ldlt_amd", "in AMD's order as it is",
                         create_tuned<SimplicialSolver<double>, Tuning::amd>, ldlt)},
      .role = Role::paper};
}

}  // namespace mbs::eigen_sparse
