// The table of `mbs sweep`: a row a lane.
#pragma once

#include <string>

#include "mbs/csv_file.hpp"
#include "sweep/lane.hpp"
#include "sweep/sweep_grid.hpp"

namespace mbs {

/// Columns: the paths that are varied; status, status_reason, failed_at, steps, passes_per_step,
/// position_error_estimate, local_error_sum, energy_drift_max, constraint_violation_max as in the
/// summary of `mbs simulate`; then NAME.last, NAME.min and NAME.max of each column of the scene's
/// outputs. A cell is empty where there is no such number.
class SweepFile {
 public:
  /// Throws UsageError if `path` cannot be written.
  SweepFile(const std::string& path, const SweepGrid& grid);
  void write(const std::vector<double>& values, const Lane& lane);
  /// The row of a lane that could not be simulated.
  void write_failed(const std::vector<double>& values, const std::string& status,
                    const std::string& reason);
  void commit() { file_.commit(); }

 private:
  std::size_t columns_, outputs_;
  CsvFile file_;
};

}  // namespace mbs
