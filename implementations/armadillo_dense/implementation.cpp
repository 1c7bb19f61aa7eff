// Describes the implementation and creates its simulations.
#include "mbs/implementation.hpp"

#include <armadillo>
#include <memory>

#include "simulation.hpp"

namespace mbs::armadillo_dense {
namespace {

constexpr Terms kTerms{Term::dots,        Term::bilinear,        Term::linear,
                       Term::springs,     Term::torsion_springs, Term::dampers,
                       Term::couples,     Term::drivers,         Term::mass_across_axes,
                       Term::spatial};

}  // namespace

Implementation implementation() {
  return {
      .description = "dense column-major storage, factorizations by LAPACK, products by BLAS",
      .library = "Armadillo",
      .version = arma::arma_version::as_string(),
      .licence = "Apache-2.0",
      .variants = {{
          .name = "potrf",
          .description =
              "tangent by dsyrk, Cholesky by dpotrf, in place; saddle-point form by dsytrf",
          .create = [](const Model& model,
                       const StepSettings& settings) -> std::unique_ptr<mbs::Simulation> {
            require_storable(model, settings.scheme);
            if (settings.scheme == Scheme::saddle_point) {
              return std::make_unique<DenseSimulation<SaddlePointSystem>>(model, settings);
            }
            return std::make_unique<DenseSimulation<PenaltySystem>>(model, settings);
          },
          .dense = true,
          .serves = {.terms = kTerms, .saddle_point = true},
      }, {
          .name = "potrs",
          .description = "solves by dpotrs, which is made for many right-hand sides",
          .create = [](const Model& model,
                       const StepSettings& settings) -> std::unique_ptr<mbs::Simulation> {
            require_storable(model, settings.scheme);
            return std::make_unique<DenseSimulation<PotrsSystem>>(model, settings);
          },
          .dense = true,
          .serves = {.terms = kTerms},
          .tried_for = "potrf",
      }},
      .role = Role::paper,
  };
}

}  // namespace mbs::armadillo_dense
