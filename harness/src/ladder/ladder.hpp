// The ladder: an implementation's quantities in the order in which they are written, up to the
// first that is wrong.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "ladder/step_rungs.hpp"
#include "registry/registry.hpp"
#include "run/isolate.hpp"

namespace mbs {

enum class RungResult { ok, not_yet, not_served, failed };

/// "ok", "not yet", "not served", "FAILED".
const char* name_of(RungResult result);

/// What one rung found.
struct RungReport {
  std::string implementation;
  std::string rung;   ///< "Phi_q", "ten steps", "springs, planar"
  std::string scene;  ///< as `mbs reference` takes it
  RungResult result = RungResult::ok;
  std::string detail;  ///< one line: why it is not served, or what failed; may be empty
  // Of a failed rung.
  Finding finding;
  std::string equation;               ///< of paper/README.md, or another file
  std::vector<std::string> mistakes;  ///< the usual ones
  std::string command;                ///< shows more: the reference's numbers, or the whole check
};

void to_json(nlohmann::json& json, const RungReport& report);

/// Climbs `variant` up the ladder, README.md here, each rung in a child process under `limits`, and
/// calls `done` after each. Stops after the first that failed.
void climb(const NamedVariant& variant, const IsolationLimits& limits,
           const std::function<void(const RungReport&)>& done);

}  // namespace mbs
