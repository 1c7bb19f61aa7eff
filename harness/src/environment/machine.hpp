// The machine that a result was measured on, without naming it.
#pragma once

#include <string>

namespace mbs {

/// Model name of the first processor with family, model and stepping, as /proc/cpuinfo has them.
std::string cpu_model();

/// Operating system and its release, "Linux 6.1.0-18-amd64".
std::string kernel();

/// Twelve hexadecimal digits: a hash of cpu_model(), processors on line, cache sizes, memory in
/// whole GiB and architecture. Equal on machines whose timings may be compared, not unique.
std::string machine_fingerprint();

/// Keeps this thread on the processor that runs it now: caches and clocks differ among them.
void stay_on_this_processor();

}  // namespace mbs
