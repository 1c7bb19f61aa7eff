// Registers compressed sparse columns with the multifrontal solver MUMPS.
#include "mbs/implementation.hpp"

#include "simulation.hpp"
#include "solver.hpp"

namespace mbs::csc_mumps {
namespace {

constexpr Terms kTerms{Term::dots,        Term::bilinear,        Term::linear,
                       Term::springs,     Term::torsion_springs, Term::dampers,
                       Term::couples,     Term::drivers,         Term::mass_across_axes,
                       Term::spatial};

}  // namespace

Implementation implementation() {
  Implementation self;
  self.description = "hand-rolled compressed sparse columns; multifrontal, positive definite";
  self.library = "MUMPS";
  self.version = MultifrontalSolver::version();
  self.licence = "CECILL-C";
  self.variants.push_back(
      {.name = "spd",
       .description =
           "SYM = 1: no pivoting, AMD ordering, analysis once (saddle-point form: SYM = 2)",
       .create = make_simulation,
       .allocates = "MUMPS allocates its workspaces anew in every call",
       .serves = {.terms = kTerms, .saddle_point = true}});
  self.role = Role::paper;
  return self;
}

}  // namespace mbs::csc_mumps
