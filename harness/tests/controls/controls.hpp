// Simulations with one defect each: what the gate must reject, and one that it must accept.
#pragma once

#include <string>

#include "mbs/implementation.hpp"

namespace mbs::test {

/// The negative controls, and "reference", which has no defect. Each is the reference itself with
/// the stated defect, so that nothing else can be what the gate objects to.
Implementation controls();

/// One of them. Throws std::invalid_argument if none has the name.
Variant control(const std::string& name);

/// The one of them that has no defect.
inline Variant reference() { return control("reference"); }

}  // namespace mbs::test
