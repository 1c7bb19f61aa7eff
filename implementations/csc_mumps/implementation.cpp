// Registers compressed sparse columns with the multifrontal solver MUMPS.
#include "mbs/implementation.hpp"

#include <memory>

#include "simulation.hpp"
#include "solver.hpp"

namespace mbs::csc_mumps {
namespace {

constexpr Terms kTerms{
    Term::dots,    Term::bilinear, Term::linear,  Term::springs,          Term::torsion_springs,
    Term::dampers, Term::couples,  Term::drivers, Term::mass_across_axes, Term::spatial};

constexpr const char* kAllocates = "MUMPS allocates its workspaces anew in every call";

template <Tuning kTuning>
std::unique_ptr<Simulation> create(const Model& model, const StepSettings& settings) {
  return make_simulation(model, settings, kTuning);
}

/// The order of the saddle-point matrix is given: `defaults` has none.
template <Tuning kTuning>
Variant tried(const char* name, const char* description) {
  return {.name = name,
          .description = description,
          .create = create<kTuning>,
          .allocates = kAllocates,
          .serves = {.terms = kTerms, .saddle_point = kTuning != Tuning::defaults},
          .tried_for = "spd"};
}

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
           "SYM = 1: no pivoting, AMD or AMF, analysis once (saddle-point form: SYM = 2)",
       .create = create<Tuning::own>,
       .allocates = kAllocates,
       .serves = {.terms = kTerms, .saddle_point = true}});
  self.variants.push_back(tried<Tuning::amd>("amd", "always in an order of minimum degree"));
  self.variants.push_back(tried<Tuning::scotch>("scotch", "in the order of Scotch"));
  self.variants.push_back(tried<Tuning::metis>("metis", "in the order of METIS"));
  self.variants.push_back(
      tried<Tuning::trees>("trees", "in an order of minimum degree with low trees"));
  self.variants.push_back(
      tried<Tuning::defaults>("defaults", "order, amalgamation and scaling as MUMPS has them"));
  self.role = Role::paper;
  return self;
}

}  // namespace mbs::csc_mumps
