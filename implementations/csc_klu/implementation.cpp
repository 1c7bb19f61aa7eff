// Description of the folder's variants and their factory.
#include "mbs/implementation.hpp"

#include "simulation.hpp"
#include "solver.hpp"

namespace mbs::csc_klu {

Implementation implementation() {
  return {
      .description = "hand-rolled compressed sparse columns, sparse LU with precomputed schedules",
      .library = "KLU",
      .version = klu_version(),
      .licence = "LGPL-2.1-or-later",
      .variants = {{.name = "refactor",
                    .description = "AMD ordering and pivots of the initial position, refactorized",
                    .create = create_simulation<Refactorization>}},
  };
}

}  // namespace mbs::csc_klu
