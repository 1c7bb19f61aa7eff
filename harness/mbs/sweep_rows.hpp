// The lines of the table of `mbs sweep`: a row a lane.
#pragma once

#include <string>
#include <vector>

#include "sweep/lane.hpp"
#include "sweep/sweep_grid.hpp"

namespace mbs {

/// Columns: the paths that are varied; status, status_reason, failed_at, steps, passes_per_step,
/// position_error_estimate, local_error_sum, energy_drift_max, imbalance_max,
/// constraint_violation_max as in the summary of `mbs simulate`; then NAME.last, NAME.min and NAME.max of each column of the scene's
/// outputs. A cell is empty where there is no such number.
class SweepRows {
 public:
  explicit SweepRows(const SweepGrid& grid);
  /// Of the columns.
  [[nodiscard]] std::string head() const;
  [[nodiscard]] std::string row(const std::vector<double>& values, const Lane& lane) const;
  /// Of a lane that could not be simulated.
  [[nodiscard]] std::string failed_row(const std::vector<double>& values, const std::string& status,
                                       const std::string& reason) const;

 private:
  std::vector<std::string> columns_;
  std::size_t outputs_;
};

}  // namespace mbs
