// Simulations with one defect each: what the gate must reject, and one that it must accept.
#pragma once

#include "mbs/implementation.hpp"

namespace mbs::test {

/// The negative controls, and "reference", which has no defect. Each is the reference itself with
/// the stated defect, so that nothing else can be what the gate objects to.
Implementation controls();

/// The one of them that has no defect.
Variant reference();

}  // namespace mbs::test
