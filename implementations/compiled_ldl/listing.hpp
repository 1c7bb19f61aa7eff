// What a scene was compiled into, as text for people.
#pragma once

#include <iosfwd>

#include "mbs/model.hpp"
#include "mbs/simulation.hpp"

namespace mbs::compiled_ldl {

/// Whether COMPILED_LDL_PRINT asks for a listing in this process, which has had none yet.
bool is_listing_due();

/// The program that `fronts` has for a scene: README.md, "Fronts", "Panels".
void list_fronts(std::ostream& out, const Model& model, const StepSettings& settings);

}  // namespace mbs::compiled_ldl
