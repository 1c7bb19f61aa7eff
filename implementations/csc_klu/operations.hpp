// The three operations of the paper's Table 2, each alone, with the step's own storage.
#pragma once

#include <memory>

#include "mbs/operations.hpp"

namespace mbs::csc_klu {

/// Sets all patterns and schedules up; `model` outlives the result.
[[nodiscard]] std::unique_ptr<Operations> create_operations(const Model& model);

}  // namespace mbs::csc_klu
