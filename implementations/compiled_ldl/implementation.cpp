// compiled_ldl: describes it and makes its simulations.
#include "mbs/implementation.hpp"

#include <iostream>

#include "listing.hpp"
#include "scalar.hpp"
#include "simulations.hpp"

namespace mbs::compiled_ldl {
namespace {

constexpr Terms kTerms{
    Term::dots,    Term::bilinear, Term::linear,  Term::springs,          Term::torsion_springs,
    Term::dampers, Term::couples,  Term::drivers, Term::mass_across_axes, Term::spatial};

constexpr Serves kFronts = {.terms = kTerms,
                            .saddle_point = true,
                            .rattle = true,
                            .multistep = true,
                            .multiplier_update = true,
                            .tangent_reuse = true,
                            .projections_every = true,
                            .single_precision = true,
                            .mixed_precision = true,
                            .geometric_stiffness = true};

std::unique_ptr<Simulation> create_fronts(const Model& model, const StepSettings& settings) {
  if (is_listing_due()) list_fronts(std::cerr, model, settings);
  switch (settings.precision) {
    case Precision::single_precision:
      return create_single(model, settings);
    case Precision::mixed:
      return create_mixed(model, settings);
    case Precision::double_precision:
      break;
  }
  return create_double(model, settings);
}

}  // namespace

Implementation implementation() {
  Variant fronts;
  fronts.name = "fronts";
  fronts.description =
      "dense fronts in a flat program, small scenes as one dense matrix; all but laws of forces";
  fronts.create = create_fronts;
  fronts.serves = kFronts;
  fronts.create_batch = create_batch;
  fronts.batch_lanes = Lanes::kCount;
  Implementation all;
  all.description = "the scene compiled at set-up; own block L D L^T";
  all.library = "none";
  all.variants = {fronts};
  return all;
}

}  // namespace mbs::compiled_ldl
