// The reference line of figures: what code written for the N-four-bar alone takes.
#pragma once

#include "mbs/implementation.hpp"

namespace mbs::limit {

/// The name it goes by where implementations are named; it is in no registry and is never ranked.
inline constexpr const char* kName = "limit/limit";

/// The paper's step with default settings, for models that are the N-four-bar and nothing else.
const Variant& variant();

}  // namespace mbs::limit
