// What this folder offers: description and factories.
#include "mbs/implementation.hpp"

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
  throw Unsupported("multistep6 is not served");
}

constexpr Terms kTerms{Term::dots,        Term::bilinear,        Term::linear,
                       Term::springs,     Term::torsion_springs, Term::dampers,
                       Term::couples,     Term::drivers,         Term::mass_across_axes,
                       Term::spatial};

constexpr Serves kServes{.terms = kTerms,
                         .saddle_point = true,
                         .rattle = true,
                         .multiplier_update = true,
                         .tangent_reuse = true,
                         .projections_every = true,
                         .mixed_precision = true};

}  // namespace

Implementation implementation() {
  return {
      .description =
          "Eigen's sparse matrices, values refreshed in place; SuperLU or simplicial LDL^T",
      .library = "Eigen, SuperLU",
      .version = versions(),
      .licence = "MPL-2.0 AND BSD-3-Clause",
      .variants = {
          {.name = "superlu",
           .description = "supernodal LU with diagonal pivots; ordering, tree and storage reused",
           .create = create<SuperluSolver>,
           .allocates = "SuperLU's dgstrf and sp_dtrsv allocate their work space in every call",
           .unsymmetric = true,
           .serves = kServes},
          {.name = "ldlt",
           .description = "Eigen's up-looking LDL^T; AMD ordering, tree lowered",
           .create = create<SimplicialSolver>,
           .serves = kServes}},
      .role = Role::paper};
}

}  // namespace mbs::eigen_sparse
