// What a constraint is called in messages.
#pragma once

#include <string>

#include "mbs/model.hpp"
#include "model_math/consistency.hpp"

namespace mbs {

/// The name of constraint `row` of Phi, fit for a message.
std::string row_name(const Model& model, int row);

/// What coordinate `i` of q is called: "B.x".
std::string variable_name(const Model& model, int i);

/// "m^2/s", or "m/s" for a linear constraint.
const char* rate_unit(const Model& model, int row);

/// The constraint's name and by how much it fails at t = 0: in metres between its points if it is a
/// distance, as Phi otherwise.
std::string describe_violation(const Model& model, const Violation& violation);

}  // namespace mbs
