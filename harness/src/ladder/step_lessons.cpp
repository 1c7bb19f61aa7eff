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
        "if only late digits differ, M a' or Q is wrong, which alpha Phi outweighs here: half of M "
        "(the model lists its lower triangle only), the sign of Q, or what springs, couples or "
        "drivers give",
        "a is that of the last step, not the predicted a'",
        "Phi_q is taken for its transpose, or alpha Phi is left out"}},
      {"T",
       "Eq. (5)",
       Look::shown,
       {"the factor dt^2/4 or alpha is left out",
        "Phi_q Phi_q^T is taken for Phi_q^T Phi_q: entry (i, j) sums Phi_q(k, i) Phi_q(k, j) over "
        "k",
        "what a pass before has added is not set to zero, or the factorization has overwritten T",
        "the upper half is filled alone: the lower one is looked at; or half of M is left out",
        "C and K of a scene with springs and dampers: (dt/2) C + (dt^2/4) K, Eq. (11)"}},
      {"Delta q",
       "Eqs. (4), (2)",
       Look::one_pass,
       {"lambda is updated before the residual: alpha Phi then counts twice",
        "the sign: T Delta q = -f",
        "q' is corrected, v' and a' are not: they get 2/dt and 4/dt^2 times Delta q",
        "the factorization, or a triangular solve: of the other half, transposed, or left out",
        "lambda starts from zero in every step instead of from the last step's lambda",
        "the step does not stop at max_passes, here 1, or projects though `projections` is none",
        "the step computes something else than what is shown above: the predictor, Phi or f is "
        "left out"}},
      {"lambda",
       "Eq. (1)",
       Look::one_pass,
       {"the sign: lambda + alpha Phi",
        "it is updated with the Phi from before Delta q: it needs Phi at the new q'",
        "the pass that converges, or that is the last, does not update it"}},
      {"v'",
       "Eq. (6)",
       Look::velocity,
       {"a step that ends at the pass limit is not projected; it has to be",
        "the right-hand side is -(dt^2/4) alpha Phi_q^T (Phi_q v* + Phi_t): a sign, a factor or "
        "Phi_q v*; what is solved is added to v*",
        "Phi_q is that of the final q': it has to be that of the last pass, which is in T; or the "
        "first form of (6) lacks C and K",
        "T was factorized anew, or q', a' or lambda is changed: Eq. (6) takes the last pass's "
        "factors and changes v' alone"}},
      {"a'",
       "Eq. (6)",
       Look::both,
       {"the projection of a leaves out (dPhi_q/dt) v', or takes the v' from before its own "
        "projection",
        "Phi_q is that of the final q': it has to be that of the last pass, which is in T",
        "the right-hand side still holds that for v', or is scaled by dt^2/4 without alpha"}},
  };
  return rungs;
}

}  // namespace mbs
