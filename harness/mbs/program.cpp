// The command line as a whole.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstring>

#include "describe/warnings.hpp"
#include "environment/blas.hpp"
#include "environment/build_info.hpp"
#include "mbs/bench_command.hpp"
#include "mbs/commands.hpp"
#include "mbs/run_program.hpp"
#include "registry/setting_names.hpp"
#include "run/run.hpp"
#include "run/settings.hpp"
#include "usage_error.hpp"

namespace mbs {
namespace {

constexpr const char* kScenes =
    "A SCENE is four-bar:N (the N-loop four-bar mechanism), four-bar:N,fill=F (with artificial\n"
    "non-zeros in M until a share F of the tangent is filled, 0 < F <= 1; ,seed=S for others), one\n"
    "of a family of mechanisms such as ladder:12 (mbs list --scenes has all), or a JSON file.";
constexpr const char* kVaried =
    "A SCENE is four-bar:N (the N-loop four-bar mechanism), one of a family (mbs list --scenes) or\n"
    "a JSON file. A lane whose start cannot be assembled is not-assembled; the others end as one\n"
    "run does.";
constexpr const char* kExits = "Exit status: 0 done, 1 a result that is not right, 2 bad input, or a file or memory failed.";

/// An option whose value is one of the names of a choice.
template <class Choice>
void add_choice(CLI::App& command, const std::string& option, Choice& value,
                const std::string& what) {
  const auto take = [&value](const std::string& name) {
    for (const auto& [known, choice] : choices<Choice>()) {
      if (known == name) value = choice;
    }
  };
  command.add_option_function<std::string>(option, take, what)
      ->default_str(name_of(value))
      ->check(CLI::IsMember(choice_names<Choice>()));
}

/// What `status` of a run may be, a line each.
std::string outcomes_text() {
  std::string text = "Outcomes of a run (bounds: harness/src/run/README.md), exit status 0:\n";
  bool finished = true;
  for (const auto& [status, name, meaning] : outcomes()) {
    if (finished && !is_finished(status)) text += "exit status 1:\n";
    finished = is_finished(status);
    text += fmt::format("  {:<14} {}\n", name, meaning);
  }
  return text +
         "Exit status 2: bad input, or a file or memory failed; standard error says why.";
}

bool is_subcommand(const CLI::App& app, const std::string& name) {
  return std::ranges::any_of(app.get_subcommands([](const CLI::App*) { return true; }),
                             [&](const CLI::App* command) { return command->get_name() == name; });
}

}  // namespace

void add_blas_option(CLI::App& command) {
  std::vector<std::string> names;
  for (const BlasPair& pair : blas_pairs()) names.push_back(pair.name);
  command
      .add_option_function<std::string>(
          "--blas", [](const std::string&) {},
          fmt::format("BLAS and LAPACK to run on, one of {} (default: the "
                      "system's; mbs list tells which are installed)",
                      fmt::join(names, ", ")))
      ->type_name("NAME");
}

void add_precision_option(CLI::App& command, Precision& precision) {
  add_choice<Precision>(command, "--precision", precision, "what a step computes in");
}

void StepOptions::add_to(CLI::App& command) {
  command.add_option("--step", settings.step, "time step, s")->capture_default_str();
  command.add_option("--penalty", penalty, "penalty factor alpha, or 'auto'")
      ->capture_default_str();
  command
      .add_option("--tolerance", tolerance,
                  "Newton stops at max |Delta q| below this, m, or 'auto'")
      ->capture_default_str();
  command.add_option("--max-passes", settings.max_passes, "passes a step at most, 1 to 1000")
      ->capture_default_str();
  add_choice<Scheme>(command, "--scheme", settings.scheme, "how a step advances the state");
  add_choice<MultiplierUpdate>(command, "--multipliers", settings.multipliers,
                               "when Newton updates lambda, in the penalty form");
  add_choice<TangentReuse>(command, "--tangent", settings.tangent,
                           "when the tangent is factorized");
  add_choice<Projections>(command, "--projections", settings.projections,
                          "what Eq. (6) corrects after a step");
  command
      .add_option("--projections-every", settings.projections_every,
                  "project every K-th step only, K >= 1")
      ->capture_default_str();
  add_precision_option(command, settings.precision);
  command.add_flag("--geometric-stiffness", settings.geometric_stiffness,
                   "add to the tangent how constraint forces change with q, Eq. (16)");
  add_blas_option(command);
}

void refuse_misread(CLI::App& command) {
  for (CLI::Option* option : command.get_options()) {
    const std::string type = option->get_type_name();
    const bool is_whole = type.starts_with("INT") || type.starts_with("UINT");
    const bool is_number = is_whole || type.starts_with("FLOAT");
    option->check([is_whole, is_number](const std::string& text) -> std::string {
      if (text.empty()) return "the value is empty";
      const bool has_sign = text[0] == '+' || text[0] == '-';
      const std::string digits = text.substr(has_sign ? 1 : 0);
      const bool is_hexadecimal = digits.starts_with("0x") || digits.starts_with("0X");
      const bool is_octal = is_whole && digits.size() > 1 && digits[0] == '0';
      if (is_number && (is_hexadecimal || is_octal)) return text + " is not a decimal number";
      return "";
    });
  }
}

NamedVariant select_variant(const std::string& name) {
  const std::vector<NamedVariant> variants = select_variants({name});
  if (variants.size() == 1) return variants[0];
  std::vector<std::string> names;
  for (const NamedVariant& variant : variants) names.push_back(variant.name);
  throw UsageError(fmt::format("--implementation '{}' has {} variants: name one of {}", name,
                               names.size(), fmt::join(names, ", ")));
}

StepSettings StepOptions::resolve(const Model& model) const {
  StepSettings result = settings;
  require_step(result.step);
  if (result.max_passes < 1 || result.max_passes > 1000) {
    throw UsageError(fmt::format("--max-passes is {}: it must be 1 to 1000", result.max_passes));
  }
  require_combination(result);
  result.penalty = parse_automatic("--penalty", penalty);
  result.tolerance = parse_automatic("--tolerance", tolerance, " (m)");
  return chosen(model, result);
}

std::vector<std::string> StepOptions::warnings(const Model& model,
                                               const StepSettings& resolved) const {
  return setting_warnings(model, resolved,
                          penalty == "auto" ? PenaltyFrom::rule : PenaltyFrom::user);
}

void print_warnings(const std::string& scene, const std::vector<std::string>& warnings) {
  for (const std::string& warning : warnings) {
    fmt::print(stderr, "mbs: warning: {}: {}\n", scene, warning);
  }
}

int run_program(int argc, char** argv) {
  if (argc > 1 && std::strcmp(argv[1], "bench") == 0) {
    std::string name = "mbs bench";
    argv[1] = name.data();
    return bench_command(argc - 1, argv + 1);
  }
  CLI::App app{"mbs: one multibody simulation on many linear algebra implementations.\n"};
  app.name("mbs");
  app.footer(fmt::format("{}\n{}", kScenes, kExits));
  app.set_version_flag("--version", build_info().version);
  app.require_subcommand(1);
  int status = 0;
  add_list_command(app, status);
  add_describe_command(app, status);
  add_simulate_command(app, status);
  add_sweep_command(app, status);
  add_merge_sweep_command(app, status);
  add_check_command(app, status);
  add_reference_command(app, status);
  add_limit_command(app, status);
  app.add_subcommand("bench",
                     "time implementations on scenes: who is fastest (see mbs bench --help)");
  for (CLI::App* command : app.get_subcommands({})) {
    refuse_misread(*command);
    command->footer(kExits);
  }
  for (const char* name : {"describe", "check", "reference"}) {
    app.get_subcommand(name)->footer(fmt::format("{}\n{}", kScenes, kExits));
  }
  for (const auto& [name, scenes] : {std::pair("simulate", kScenes), std::pair("sweep", kVaried)}) {
    app.get_subcommand(name)->footer(std::string(scenes) + "\n\n" + outcomes_text());
  }
  if (argc > 1 && argv[1][0] != '-' && !is_subcommand(app, argv[1])) {
    throw UsageError(fmt::format(
        "unknown subcommand '{}': there are list, describe, simulate, sweep, merge-sweep, check, reference, "
        "limit, bench",
        argv[1]));
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);
    throw UsageError(fmt::format("{} (mbs --help, mbs <subcommand> --help)", error.what()));
  }
  return status;
}

}  // namespace mbs
