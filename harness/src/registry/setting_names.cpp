// One table a choice.
#include "registry/setting_names.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "usage_error.hpp"

namespace mbs {

template <>
const std::vector<std::pair<std::string, Scheme>>& choices<Scheme>() {
  static const std::vector<std::pair<std::string, Scheme>> all{
      {"penalty", Scheme::penalty}, {"saddle-point", Scheme::saddle_point},
      {"rattle", Scheme::rattle},   {"rattle4", Scheme::rattle4},
      {"rattle6", Scheme::rattle6}, {"multistep6", Scheme::multistep6}};
  return all;
}

template <>
const std::vector<std::pair<std::string, Projections>>& choices<Projections>() {
  static const std::vector<std::pair<std::string, Projections>> all{
      {"both", Projections::both},
      {"velocity", Projections::velocity},
      {"none", Projections::none}};
  return all;
}

template <>
const std::vector<std::pair<std::string, MultiplierUpdate>>& choices<MultiplierUpdate>() {
  static const std::vector<std::pair<std::string, MultiplierUpdate>> all{
      {"every-pass", MultiplierUpdate::every_pass}, {"converged", MultiplierUpdate::converged}};
  return all;
}

template <>
const std::vector<std::pair<std::string, TangentReuse>>& choices<TangentReuse>() {
  static const std::vector<std::pair<std::string, TangentReuse>> all{
      {"every-pass", TangentReuse::none},
      {"every-step", TangentReuse::step},
      {"kept", TangentReuse::kept}};
  return all;
}

template <>
const std::vector<std::pair<std::string, Precision>>& choices<Precision>() {
  static const std::vector<std::pair<std::string, Precision>> all{
      {"double", Precision::double_precision},
      {"single", Precision::single_precision},
      {"mixed", Precision::mixed}};
  return all;
}

bool is_explicit(Scheme scheme) {
  return scheme != Scheme::penalty && scheme != Scheme::saddle_point;
}

void require_combination(const StepSettings& s) {
  if (s.projections_every < 1) {
    throw UsageError(
        fmt::format("--projections-every is {}: it must be at least 1", s.projections_every));
  }
  const auto refuse = [&](const std::string& option, const std::string& allowed) {
    throw UsageError(fmt::format("--scheme {} and {} do not go together: it goes with {}",
                                 name_of(s.scheme), option, allowed));
  };
  if (s.scheme != Scheme::penalty && s.multipliers != MultiplierUpdate::every_pass) {
    refuse("--multipliers " + name_of(s.multipliers), "every-pass");
  }
  if (is_explicit(s.scheme)) {
    if (s.tangent != TangentReuse::none) refuse("--tangent " + name_of(s.tangent), "every-pass");
    if (s.projections != Projections::both) {
      refuse("--projections " + name_of(s.projections), "both");
    }
    if (s.projections_every != 1) {
      refuse(fmt::format("--projections-every {}", s.projections_every), "1");
    }
    if (s.precision == Precision::mixed) {
      refuse("--precision mixed", s.scheme == Scheme::multistep6 ? "double" : "double and single");
    }
    if (s.scheme == Scheme::multistep6 && s.precision == Precision::single_precision) {
      refuse("--precision single", "double");
    }
    if (s.geometric_stiffness) refuse("--geometric-stiffness", "none: its tangent is exact");
  }
  if (s.projections == Projections::none && s.projections_every != 1) {
    throw UsageError("--projections none and --projections-every do not go together");
  }
}

void require_step(double step) {
  if (step >= 1e-12 && step <= 1e6) return;
  throw UsageError(fmt::format("--step is {:g} s: it must be 1e-12 to 1e6 s", step));
}

nlohmann::json settings_json(const StepSettings& s) {
  return {{"step", s.step},
          {"penalty", s.penalty},
          {"tolerance", s.tolerance},
          {"max_passes", s.max_passes},
          {"scheme", name_of(s.scheme)},
          {"multipliers", name_of(s.multipliers)},
          {"tangent", name_of(s.tangent)},
          {"projections", name_of(s.projections)},
          {"projections_every", s.projections_every},
          {"precision", name_of(s.precision)},
          {"geometric_stiffness", s.geometric_stiffness}};
}

std::string other_settings(const StepSettings& s) {
  const StepSettings usual;
  std::vector<std::string> options;
  const auto add = [&](const char* option, auto value, auto default_value) {
    if (value != default_value) options.push_back(fmt::format("--{} {}", option, name_of(value)));
  };
  add("scheme", s.scheme, usual.scheme);
  add("multipliers", s.multipliers, usual.multipliers);
  add("tangent", s.tangent, usual.tangent);
  add("projections", s.projections, usual.projections);
  if (s.projections_every != 1) {
    options.push_back(fmt::format("--projections-every {}", s.projections_every));
  }
  add("precision", s.precision, usual.precision);
  if (s.geometric_stiffness) options.emplace_back("--geometric-stiffness");
  return fmt::format("{}", fmt::join(options, " "));
}

}  // namespace mbs
