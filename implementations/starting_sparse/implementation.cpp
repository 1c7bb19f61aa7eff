// What this folder offers to the registry: the classical sparse implementation on MUMPS.
#include "mbs/implementation.hpp"

#include "simulation.hpp"
#include "solver.hpp"

namespace mbs::starting_sparse {
namespace {

constexpr Terms kTerms{Term::dots,        Term::bilinear,        Term::linear,
                       Term::springs,     Term::torsion_springs, Term::dampers,
                       Term::couples,     Term::drivers,         Term::mass_across_axes,
                       Term::spatial};

}  // namespace

Implementation implementation() {
  return {
      .description = "coordinate format with duplicates, dense Jacobian; multifrontal LDL'",
      .library = "MUMPS",
      .version = Solver::library_version(),
      .licence = "CECILL-C",
      .variants = {{.name = "mumps",
                    .description = "SYM = 2, AMD ordering, analysis once, no scaling",
                    .create = create,
                    .allocates = "MUMPS allocates its workspaces anew in every call",
                    .serves = {.terms = kTerms}}},
      .role = Role::paper,
  };
}

}  // namespace mbs::starting_sparse
