// What this folder offers: one variant on SuiteSparse's LDL.
#include "mbs/implementation.hpp"

#include "simulation.hpp"
#include "solver.hpp"

namespace mbs::csc_ldl {
namespace {

template <Order kOrder>
std::unique_ptr<Simulation> create(const Model& model, const StepSettings& settings) {
  return std::make_unique<LdlSimulation>(model, settings, kOrder);
}

}  // namespace

Implementation implementation() {
  const Serves serves{
      .terms = {Term::dots, Term::bilinear, Term::linear, Term::springs, Term::torsion_springs,
                Term::dampers, Term::couples, Term::force_laws, Term::drivers,
                Term::mass_across_axes, Term::spatial},
      .saddle_point = true};
  return {.description = "compressed sparse columns, upper triangle, in the order of elimination",
          .library = "LDL",
          .version = ldl_version(),
          .licence = "LGPL-2.1-or-later",
          .variants = {{.name = "uplooking",
                        .description = "LDL's up-looking LDL', AMD order, tree lowered, own solves",
                        .create = create<Order::lowest_tree>,
                        .serves = serves},
                       {.name = "amd",
                        .description = "in AMD's order as it is",
                        .create = create<Order::amd>,
                        .serves = serves,
                        .tried_for = "uplooking"}}};
}

}  // namespace mbs::csc_ldl
