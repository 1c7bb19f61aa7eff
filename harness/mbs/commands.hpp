// The subcommands of `mbs`, each adding itself to the program's command line.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "mbs/simulation.hpp"
#include "registry/registry.hpp"

namespace mbs {

/// Each adds one subcommand whose callback stores the exit status in `status`.
void add_list_command(CLI::App& app, int& status);
void add_describe_command(CLI::App& app, int& status);
void add_simulate_command(CLI::App& app, int& status);
void add_sweep_command(CLI::App& app, int& status);
void add_merge_sweep_command(CLI::App& app, int& status);
void add_check_command(CLI::App& app, int& status);
void add_reference_command(CLI::App& app, int& status);
void add_limit_command(CLI::App& app, int& status);

/// Adds --blas to `command`, for its help; main() has already obeyed it (settle_environment()).
void add_blas_option(CLI::App& command);

/// Adds --precision to `command`.
void add_precision_option(CLI::App& command, Precision& precision);

/// Time-stepping options as typed; "auto" needs the model.
struct StepOptions {
  StepSettings settings;  ///< but for the next two
  std::string penalty = "auto";
  std::string tolerance = "auto";

  /// Adds an option for every one of StepSettings, and --blas, to `command`.
  void add_to(CLI::App& command);
  /// Throws UsageError if a value is out of range.
  [[nodiscard]] StepSettings resolve(const Model& model) const;
  /// What about `resolved`, these for `model`, is likely to spoil its motion.
  [[nodiscard]] std::vector<std::string> warnings(const Model& model,
                                                  const StepSettings& resolved) const;
};

/// A line on stderr for each of `warnings` about `scene`.
void print_warnings(const std::string& scene, const std::vector<std::string>& warnings);

/// Makes every option and argument of `command` refuse what would be read as something else: an
/// empty text as 0 or as not given, the number 010 as 8, 0x10 as 16.
void refuse_misread(CLI::App& command);

/// The one variant that the value of --implementation names. Throws UsageError.
NamedVariant select_variant(const std::string& name);

}  // namespace mbs
