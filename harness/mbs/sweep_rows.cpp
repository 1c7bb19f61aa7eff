// From lanes to rows.
#include "mbs/sweep_rows.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "mbs/csv_file.hpp"
#include "printable.hpp"
#include "usage_error.hpp"

namespace mbs {
namespace {

std::vector<std::string> columns_of(const SweepGrid& grid) {
  std::vector<std::string> columns;
  for (const SweepAxis& axis : grid.axes()) columns.push_back(axis.path);
  columns.insert(columns.end(), {"status", "status_reason", "failed_at", "steps", "passes_per_step",
                                 "position_error_estimate", "local_error_sum", "energy_drift_max",
                                 "imbalance_max", "constraint_violation_max"});
  const OutputValues outputs(grid.base());
  for (const std::string& name : outputs.columns()) {
    for (const char* what : {".last", ".min", ".max"}) columns.push_back(name + what);
  }
  return columns;
}

std::string cell(std::optional<double> value) {
  return value && std::isfinite(*value) ? fmt::format("{}", *value) : "";
}

}  // namespace

SweepRows::SweepRows(const SweepGrid& grid)
    : columns_(columns_of(grid)), outputs_(OutputValues(grid.base()).columns().size()) {
  for (std::size_t i = grid.axes().size(); i < columns_.size(); ++i) {
    for (const SweepAxis& axis : grid.axes()) {
      if (axis.path != columns_[i]) continue;
      throw UsageError(
          fmt::format("--vary {}: found the name of a column of the table, allowed is {}",
                      in_quotes(axis.path), in_quotes("parameters/" + axis.path)));
    }
  }
}

std::string SweepRows::head() const { return csv_line(columns_); }

std::string SweepRows::failed_row(const std::vector<double>& values, const std::string& status,
                                  const std::string& reason) const {
  std::vector<std::string> row;
  for (const double value : values) row.push_back(cell(value));
  row.push_back(status);
  row.push_back(reason);
  row.resize(columns_.size());
  return csv_line(row);
}

std::string SweepRows::row(const std::vector<double>& values, const Lane& lane) const {
  const RunSummary& summary = lane.summary;
  const bool stepped = summary.steps > 0;
  std::vector<std::string> row;
  for (const double value : values) row.push_back(cell(value));
  row.push_back(to_string(summary.status));
  row.push_back(summary.reason);
  row.push_back(cell(summary.failed_at));
  row.push_back(fmt::format("{}", summary.steps));
  row.push_back(stepped
                    ? cell(static_cast<double>(summary.passes) / static_cast<double>(summary.steps))
                    : "");
  row.push_back(cell(summary.position_error_estimate));
  row.push_back(cell(summary.local_error_sum));
  row.push_back(stepped ? cell(summary.energy_drift_max) : "");
  row.push_back(stepped ? cell(summary.imbalance_max) : "");
  row.push_back(stepped ? cell(summary.constraint_violation_max) : "");
  for (std::size_t i = 0; i < outputs_; ++i) {
    if (lane.outputs.empty()) {
      row.insert(row.end(), 3, "");
    } else {
      const Extremes& output = lane.outputs[i];
      row.insert(row.end(), {cell(output.last), cell(output.least), cell(output.most)});
    }
  }
  return csv_line(row);
}

}  // namespace mbs
