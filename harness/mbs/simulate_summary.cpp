// A run's figures as JSON and as text.
#include "mbs/simulate_summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "describe/describe.hpp"
#include "registry/setting_names.hpp"

namespace mbs {
namespace {

nlohmann::json finite_or_null(std::optional<double> value) {
  if (!value || !std::isfinite(*value)) return nullptr;
  return *value;
}

nlohmann::json times_json(const StepTimes& us) {
  nlohmann::json json = {{"mean", us.mean}, {"median", us.median}, {"p99", us.p99},
                         {"p999", us.p999}, {"max", us.max},       {"deadline_misses", nullptr}};
  if (us.deadline_misses) json["deadline_misses"] = *us.deadline_misses;
  return json;
}

/// The value, or why there is none: a run that was lost, or else `without`.
std::string figure(std::optional<double> value, const char* unit, const char* without = "") {
  if (!value) return without;
  if (!std::isfinite(*value)) return "not known: the run was lost";
  return fmt::format("{:.3g}{}", *value, unit);
}

/// One line, and one more where there is a deadline.
std::string times_text(const std::string& label, const nlohmann::json& us,
                       const nlohmann::json& run) {
  std::string text =
      fmt::format("  {:<22} {:.2f} us median, {:.2f} p99, {:.2f} max\n", label,
                  us["median"].get<double>(), us["p99"].get<double>(), us["max"].get<double>());
  if (us["deadline_misses"].is_null()) return text;
  return text + fmt::format("    deadline             {} of {} steps took more than {:g} us\n",
                            us["deadline_misses"].get<long>(), run["steps"].get<long>(),
                            run["deadline_us"].get<double>());
}

}  // namespace

nlohmann::json summary_json(const Scene& scene, const NamedVariant& variant,
                            const RunSettings& settings, const RunSummary& summary) {
  const double steps = static_cast<double>(std::max(summary.steps, 1L));
  nlohmann::json json = settings_json(settings.step);
  json.update({{"scene", scene.name},
               {"implementation", variant.name},
               {"variables", scene.model.variables()},
               {"constraints", scene.model.constraints()},
               {"tangent_nonzeros", tangent_nonzeros(scene.model)},
               {"duration", settings.duration},
               {"other_settings", other_settings(settings.step)},
               {"assembly", assembly_json(scene.assembly)},
               {"status", to_string(summary.status)},
               {"status_reason", summary.reason},
               {"branch_doubt", summary.branch_doubt},
               {"forces_lost", summary.forces_lost},
               {"failed_at", finite_or_null(summary.failed_at)},
               {"steps", summary.steps},
               {"steps_at_limit", summary.steps_at_limit},
               {"passes_per_step", static_cast<double>(summary.passes) / steps},
               {"factorizations_per_step", static_cast<double>(summary.factorizations) / steps},
               {"position_error_max", finite_or_null(summary.position_error_max)},
               {"position_error_estimate", finite_or_null(summary.position_error_estimate)},
               {"local_error_sum", finite_or_null(summary.local_error_sum)},
               {"energy_drift_max", finite_or_null(summary.energy_drift_max)},
               {"imbalance_max", finite_or_null(summary.imbalance_max)},
               {"constraint_violation_max", finite_or_null(summary.constraint_violation_max)},
               {"setup_us", summary.setup_us},
               {"judge_us", summary.judge_us},
               {"step_us", times_json(summary.step_us)},
               {"least_us", summary.least_us ? times_json(*summary.least_us) : nullptr},
               {"repeats", settings.repeats},
               {"scale_equations", settings.scale_equations},
               {"deadline_us", finite_or_null(settings.deadline_us)}});
  if (settings.scale_equations) {
    const std::string other = json["other_settings"];
    json["other_settings"] = fmt::format("{}{}--scale-equations", other, other.empty() ? "" : " ");
  }
  return json;
}

std::string summary_text(const nlohmann::json& json, const RunSummary& summary) {
  std::string text = fmt::format("{} on {}\n", json["implementation"].get<std::string>(),
                                 json["scene"].get<std::string>());
  text += fmt::format("  status                 {}{}\n", json["status"].get<std::string>(),
                      summary.status == RunStatus::plausible ? ": " + summary.reason : "");
  text += fmt::format(
      "  size                   {} variables, {} constraints, {} non-zeros in the tangent\n",
      json["variables"].get<int>(), json["constraints"].get<int>(),
      json["tangent_nonzeros"].get<long>());
  text += fmt::format(
      "  settings               step {:g} s, penalty {:.4g}, tolerance {:g} m{}\n",
      json["step"].get<double>(), json["penalty"].get<double>(), json["tolerance"].get<double>(),
      json["other_settings"] == "" ? std::string()
                                   : ", " + json["other_settings"].get<std::string>());
  text += fmt::format("  start                  {}\n", assembly_text(json["assembly"]));
  if (summary.steps == 0) return text + "  steps                  none was done\n";
  const double passes = json["passes_per_step"], factorizations = json["factorizations_per_step"];
  text += fmt::format(
      "  steps                  {} to {:g} s, {:.3f} passes{} each, {} at the pass limit\n",
      json["steps"].get<long>(), json["steps"].get<double>() * json["step"].get<double>(), passes,
      factorizations == passes ? "" : fmt::format(" and {:.3f} factorizations", factorizations),
      json["steps_at_limit"].get<long>());
  const bool estimated = summary.position_error_estimate.has_value();
  text += fmt::format("  position error max     {}\n",
                      figure(summary.position_error_max, " m",
                             estimated ? "not known: this scene has no exact motion"
                                       : "not known: this scene has no exact motion (--half-step "
                                         "estimates it)"));
  if (estimated) {
    text += fmt::format("  estimated error max    {}\n",
                        figure(summary.position_error_estimate, " m, by half the step"));
  }
  if (!json["local_error_sum"].is_null()) {
    text +=
        fmt::format("  local errors add up to {:.3g} m\n", json["local_error_sum"].get<double>());
  }
  if (summary.imbalance_max) {
    text += fmt::format("  energy off the work by {}\n", figure(summary.imbalance_max, " of it"));
  } else {
    text += fmt::format("  energy drift max       {}\n",
                        figure(summary.energy_drift_max, " of its scale",
                               "not judged: drivers alone set the motion"));
  }
  text += fmt::format("  constraint violation   {}\n",
                      figure(summary.constraint_violation_max, " m^2 (m of linear rows)"));
  text += fmt::format("  set-up                 {:.1f} us\n", json["setup_us"].get<double>());
  text +=
      fmt::format("  judging                {:.2f} us a step\n", json["judge_us"].get<double>());
  text += times_text("step", json["step_us"], json);
  if (!json["least_us"].is_null()) {
    text += times_text(fmt::format("least of {} runs", json["repeats"].get<int>()),
                       json["least_us"], json);
  }
  return text;
}

}  // namespace mbs
