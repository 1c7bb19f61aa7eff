// What this folder offers to the registry: UMFPACK on hand-rolled compressed sparse columns.
#include "mbs/implementation.hpp"

#include <umfpack.h>

#include <memory>
#include <string>
#include <utility>

#include "penalty_system.hpp"
#include "saddle_point_system.hpp"
#include "simulation.hpp"

namespace mbs::csc_umfpack {
namespace {

constexpr Terms kTerms{
    Term::dots,    Term::bilinear, Term::linear,  Term::springs,          Term::torsion_springs,
    Term::dampers, Term::couples,  Term::drivers, Term::mass_across_axes, Term::spatial};

template <template <int> class System>
std::unique_ptr<Simulation> create_with(const Model& model, const StepSettings& settings,
                                        Tuning tuning) {
  if (model.dimension() == 2) {
    return std::make_unique<CscUmfpack<2, System>>(model, settings, tuning);
  }
  return std::make_unique<CscUmfpack<3, System>>(model, settings, tuning);
}

template <Tuning kTuning>
std::unique_ptr<Simulation> create(const Model& model, const StepSettings& settings) {
  return settings.scheme == Scheme::saddle_point
             ? create_with<SaddlePointSystem>(model, settings, kTuning)
             : create_with<PenaltySystem>(model, settings, kTuning);
}

template <Tuning kTuning>
Variant tried(std::string name, std::string description) {
  return {.name = std::move(name),
          .description = std::move(description),
          .create = create<kTuning>,
          .unsymmetric = true,
          .serves = {.terms = kTerms, .saddle_point = true},
          .tried_for = "symmetric"};
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
                    .description =
                        "one symbolic analysis (symmetric strategy, AMD or model's order), "
                        "no scaling, diagonal pivots, numeric factorization every pass",
                    .create = create<Tuning::own>,
                    .unsymmetric = true,
                    .serves = {.terms = kTerms, .saddle_point = true}},
                   tried<Tuning::amd>("amd", "always in AMD's order"),
                   tried<Tuning::metis>("metis", "in the order of METIS"),
                   tried<Tuning::trees>("trees", "in an order of minimum degree with low trees"),
                   tried<Tuning::defaults>("defaults", "UMFPACK's defaults, refinement too")},
  };
}

}  // namespace mbs::csc_umfpack
