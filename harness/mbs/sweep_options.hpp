// What a user asks `mbs sweep` for.
#pragma once

#include <string>
#include <vector>

#include "mbs/commands.hpp"
#include "sweep/sample.hpp"

namespace mbs {

struct SweepOptions {
  std::string scene;
  std::vector<std::string> vary;
  std::string implementation;
  StepOptions step;
  double duration = 20.0;
  bool half_step = false;
  Sampling sampling;
  int jobs = 1;
  std::string shard;
  bool resume = false;
  bool check = false;  // prepares the lanes only
  std::string output;
  std::string identity;  // all options that the rows depend on
};

/// Runs all of it; the exit status. Throws UsageError.
int sweep(const SweepOptions& options);

}  // namespace mbs
