// compiled_ldl: describes it and makes its simulations.
#include "mbs/implementation.hpp"

#include "batch.hpp"
#include "scalar.hpp"
#include "simulations.hpp"

namespace mbs::compiled_ldl {
namespace {

std::unique_ptr<Simulation> create_block(const Model& model, const StepSettings& settings) {
  switch (settings.precision) {
    case Precision::single_precision:
      return create_single(model, settings);
    case Precision::mixed:
      return create_mixed(model, settings);
    default:
      return create_double(model, settings);
  }
}

}  // namespace

Implementation implementation() {
  Variant block;
  block.name = "block";
  block.description = "fronts of points, merged and ordered by predicted time, fixed positions";
  block.create = create_block;
  block.serves = {.saddle_point = true,
                  .rattle = true,
                  .multiplier_update = true,
                  .tangent_reuse = true,
                  .projections_every = true,
                  .single_precision = true,
                  .mixed_precision = true,
                  .geometric_stiffness = true};
  block.create_batch = create_batch;
  block.batch_lanes = Lanes::kCount;
  Implementation all;
  all.description = "the scene compiled into a flat program; block L D L^T in dense fronts";
  all.library = "none";
  all.variants.push_back(block);
  return all;
}

}  // namespace mbs::compiled_ldl
