// Describes this implementation to the harness and creates its simulations.
#include "mbs/implementation.hpp"

#include <klu.h>

#include <boost/version.hpp>
#include <string>
#include <utility>

#include "operations.hpp"
#include "simulation.hpp"

namespace mbs::ublas_sparse {
namespace {

constexpr Terms kTerms{Term::dots,        Term::bilinear,        Term::linear,
                       Term::springs,     Term::torsion_springs, Term::dampers,
                       Term::couples,     Term::drivers,         Term::mass_across_axes,
                       Term::spatial};

std::string versions() {
  const std::string boost = std::to_string(BOOST_VERSION / 100000) + "." +
                            std::to_string(BOOST_VERSION / 100 % 1000) + "." +
                            std::to_string(BOOST_VERSION % 100);
  const std::string klu = std::to_string(KLU_MAIN_VERSION) + "." + std::to_string(KLU_SUB_VERSION) +
                          "." + std::to_string(KLU_SUBSUB_VERSION);
  return boost + " + " + klu;
}

template <class Product>
Variant variant(std::string name, std::string description) {
  return {
      .name = std::move(name),
      .description = std::move(description),
      .create = [](const Model& model,
                   const StepSettings& settings) -> std::unique_ptr<Simulation> {
        return std::make_unique<UblasSimulation<Product>>(model, settings);
      },
      .unsymmetric = true,
      .serves = {.terms = kTerms},
      .operations = [](const Model& model) -> std::unique_ptr<Operations> {
        return std::make_unique<UblasOperations<Product>>(model);
      },
  };
}

}  // namespace

Implementation implementation() {
  return {
      .description = "compressed columns; uBLAS operations, no symbolic preprocessing; LU by KLU",
      .library = "Boost.uBLAS + KLU",
      .version = versions(),
      .licence = "BSL-1.0 AND LGPL-2.1-or-later",
      .variants =
          {
              variant<ExpressionProduct>("plain", "rank-k update as prod(trans(A), A)"),
              variant<AxpyProduct>("axpy_prod",
                                   "rank-k update by axpy_prod from a stored transpose"),
          },
      .role = Role::paper,
  };
}

}  // namespace mbs::ublas_sparse
