// A clock that makes no check depend on what else the machine does.
#pragma once

#include <ctime>

namespace mbs {

/// Processor time of this process, s.
inline double processor_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

}  // namespace mbs
