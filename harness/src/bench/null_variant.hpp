// The control of every measurement: a simulation that does nothing.
#pragma once

#include "mbs/implementation.hpp"

namespace mbs {

/// What its steps take is the harness's own overhead. It keeps the state it was given and reports
/// every step as converged after one pass; it is in no registry and can never be ranked.
const Variant& null_variant();

}  // namespace mbs
