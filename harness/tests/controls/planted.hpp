// A small dense implementation into which a mistake that beginners make can be planted.
#pragma once

#include <vector>

#include "mbs/implementation.hpp"

namespace mbs::test {

/// Each serves the default terms and shows its first pass; "hidden_lambda_first" does not. "right";
/// "half_jacobian": Phi_q without its factor 2; "half_mass": M without its upper half;
/// "lambda_first": lambda is updated before the residual; "lambda_sign": lambda - alpha Phi;
/// "no_curvature": a is projected without (Phi_q)' v; "always_both": a is projected unasked.
std::vector<Variant> planted();

}  // namespace mbs::test
