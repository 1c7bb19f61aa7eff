// What each rung of a step teaches.
#include "ladder/step_rungs.hpp"

namespace mbs {

const std::vector<StepRung>& step_rungs() {
  using Look = StepRung::Look;
  static const std::vector<StepRung> rungs{
      {"predict",
       "Eq. (2)",
       Look::shown,
       {"nothing is predicted yet: the state is still that of the last step",
        "v' or a' is computed from a q, v or a that was overwritten just before",
        "dt^2/2 a is left out of q'"}},
      {"Phi",
       "Eqs. (7), (8)",
       Look::shown,
       {"it is evaluated before the predictor, at q instead of q'",
        "a length is subtracted where its square is asked for: `value` is in m^2",
        "a fixed point is read from q: its offset is -1, its place is `position`",
        "driven points and values are taken at the start of the step, not at time()"}},
      {"Phi_q",
       "Eqs. (7), (8)",
       Look::shown,
       {"the factor 2 of a distance: its row is 2 u at r_a, -2 u at r_b",
        "entries of points that coincide are assigned, not added up; or added to those of the pass "
        "before",
        "it is stored by columns: entry (k, i) belongs at k n + i"}},
      {"f",
       "Eq. (3)",
       Look::shown,
       {"lambda is updated before the residual: alpha Phi then counts twice",
        "the factor dt^2/4, or the sign: Eq. (4) is solved with -f, here f itself is asked for",
        "half of M: the model lists its lower triangle only",
        "a is that of the last step, not the predicted a'; or Q lacks what springs, couples or "
        "drivers give"}},
      {"T",
       "Eq. (5)",
       Look::shown,
       {"the factor dt^2/4 or alpha is left out",
        "what a pass before has added is not set to zero, or the factorization has overwritten T",
        "C and K of a scene with springs and dampers: (dt/2) C + (dt^2/4) K, Eq. (11)"}},
      {"Delta q",
       "Eqs. (4), (2)",
       Look::one_pass,
       {"lambda is updated before the residual: alpha Phi then counts twice",
        "the sign: T Delta q = -f",
        "q' is corrected, v' and a' are not: they get 2/dt and 4/dt^2 times Delta q",
        "the step computes something else than what is shown above: the predictor, Phi or f is "
        "left out"}},
      {"lambda",
       "Eq. (1)",
       Look::one_pass,
       {"it is updated with the Phi from before Delta q: it needs Phi at the new q'",
        "the pass that converges, or that is the last, does not update it",
        "it starts from zero in every step instead of from the last step's lambda"}},
      {"v'",
       "Eq. (6)",
       Look::velocity,
       {"a step that ends at the pass limit is not projected; it has to be",
        "Phi_q is that of the final q': it has to be that of the last pass, which is in T; or a "
        "product with T_0 lacks C and K",
        "the right-hand side lacks Phi_t of drivers",
        "T was factorized anew, or q', a' or lambda is changed: Eq. (6) takes the last pass's "
        "factors and changes v' alone"}},
      {"a'",
       "Eq. (6)",
       Look::both,
       {"the projection of a leaves out (dPhi_q/dt) v', or takes the v' from before its own "
        "projection",
        "Phi_q is that of the final q': it has to be that of the last pass, which is in T",
        "it is scaled by dt^2/4 without alpha"}},
  };
  return rungs;
}

}  // namespace mbs
