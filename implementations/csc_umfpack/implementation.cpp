// What this folder offers to the registry: UMFPACK on hand-rolled compressed sparse columns.
#include "mbs/implementation.hpp"

#include <umfpack.h>

#include <memory>
#include <string>

#include "penalty_system.hpp"
#include "saddle_point_system.hpp"
#include "simulation.hpp"

namespace mbs::csc_umfpack {
namespace {

constexpr Terms kTerms{Term::dots,        Term::bilinear,        Term::linear,
                       Term::springs,     Term::torsion_springs, Term::dampers,
                       Term::couples,     Term::drivers,         Term::mass_across_axes,
                       Term::spatial};

template <template <int> class System>
std::unique_ptr<Simulation> create_with(const Model& model, const StepSettings& settings) {
  if (model.dimension() == 2) return std::make_unique<CscUmfpack<2, System>>(model, settings);
  return std::make_unique<CscUmfpack<3, System>>(model, settings);
}

std::unique_ptr<Simulation> create(const Model& model, const StepSettings& settings) {
  return settings.scheme == Scheme::saddle_point ? create_with<SaddlePointSystem>(model, settings)
                                                 : create_with<PenaltySystem>(model, settings);
}

std::string version() {
  return std::to_string(UMFPACK_MAIN_VERSION) + "." + std::to_string(UMFPACK_SUB_VERSION) + "." +
         std::to_string(UMFPACK_SUBSUB_VERSION);
}

}  // namespace

Implementation implementation();  // the registry's declaration

Implementation implementation() {
  return {
      .description = "both triangles in compressed sparse columns, multifrontal LU",
      .library = "UMFPACK",
      .version = version(),
      .licence = "GPL-2.0-or-later",
      .variants = {{.name = "symmetric",
                    .description = "one symbolic analysis (symmetric strategy, AMD), no scaling, "
                                   "diagonal pivots, a numeric factorization every pass",
                    .create = create,
                    .unsymmetric = true,
                    .serves = {.terms = kTerms, .saddle_point = true}}},
  };
}

}  // namespace mbs::csc_umfpack
