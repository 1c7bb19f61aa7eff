// Runs work in a child process, so that whatever kills it is a result and not the end.
#pragma once

#include <cstddef>
#include <functional>
#include <string>

namespace mbs {

struct IsolationLimits {
  double seconds = 120.0;                    ///< wall clock
  std::size_t bytes = std::size_t{4} << 30;  ///< address space; not enforced under sanitizers
};

enum class Fate {
  finished,       ///< `output` is what the work returned
  threw,          ///< `reason` is the exception's message
  crashed,        ///< killed by a signal, or exited on its own
  timeout,        ///< ran into the time limit and was killed
  out_of_memory,  ///< an allocation failed under the memory limit
};

struct Isolated {
  Fate fate = Fate::finished;
  std::string reason;  ///< one line, empty if finished
  std::string output;
};

/// Forks, runs `work` in the child under `limits`, and returns its string or how it ended. Call it
/// from a single-threaded process only.
Isolated run_isolated(const std::function<std::string()>& work, const IsolationLimits& limits = {});

}  // namespace mbs
