// The description as text, printed from the JSON.
#include "describe/describe_text.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "describe/describe.hpp"
#include "describe/elimination.hpp"
#include "describe/terms.hpp"
#include "run/judge.hpp"

namespace mbs {
namespace {

using nlohmann::json;

std::string matrix_text(const json& matrix, const char* of) {
  return fmt::format("{} non-zeros, {:.4g} % of {}", matrix["nonzeros"].get<long>(),
                     100.0 * matrix["fill"].get<double>(), of);
}

std::string points_text(const json& d) {
  std::string text = fmt::format("{} free", d["free_points"].get<long>());
  const auto add = [&](const char* key, const char* what) {
    if (d[key] != 0) text += fmt::format(", {} {}", d[key].get<long>(), what);
  };
  add("free_vectors", "free unit vector(s)");
  add("driven_points", "driven");
  add("driven_vectors", "driven unit vector(s)");
  add("fixed_vectors", "fixed unit vector(s)");
  return fmt::format("{} ({} and {} fixed point(s) in {} dimensions)", d["variables"].get<int>(),
                     text, d["fixed_points"].get<long>(), d["dimension"].get<int>());
}

std::string freedom_text(const json& d) {
  const json& rank = d["jacobian_rank"];
  return fmt::format("{} ({})", d["degrees_of_freedom"].get<int>(),
                     rank.is_null() ? "n - m; the rank was not computed, it is too much work"
                                    : fmt::format("n - rank of the Jacobian, {}", rank.get<int>()));
}

std::string redundant_text(const json& d) {
  const json& names = d["redundant_constraints"];
  if (d["jacobian_rank"].is_null()) return "not computed";
  if (names.empty()) return "none";
  return fmt::format("{}, implied by those before them: {}", names.size(), listed(names));
}

std::string start_text(const json& d) {
  const json& singular = d["singular_start"];
  if (singular.is_null()) return "not known to be regular: no position nearby was found";
  if (singular == false) return "regular";
  return fmt::format("singular, rank {} only: {} hold(s) nothing there that others do not",
                     singular["rank"].get<int>(), listed(singular["constraints"]));
}

std::string length_text(const json& d) {
  constexpr AccurateBounds bounds;
  const double length = d["judged_length"];
  return fmt::format(
      "{:.3g} m, of the fastest part: ok to an estimated error (--half-step) of {:.2g} m, "
      "plausible to a sum of local errors of {:.2g} m",
      length, bounds.estimated_error * length, bounds.local_error * length);
}

std::string penalty_text(const json& window) {
  if (window.is_null()) return "any, there are no constraints";
  const double lower = window["lower"], upper = window["upper"];
  const std::string step = fmt::format("for step {:g} s", window["step"].get<double>());
  const std::string rest = fmt::format("automatic {:.2g}", window["automatic"].get<double>());
  if (!(lower <= upper)) {
    return fmt::format(
        "none meets both bounds: {:.2g} at least ({}), {:.2g} at most ({}), estimated {}; {}",
        lower, window["lower_from"].get<std::string>(), upper,
        window["upper_from"].get<std::string>(), step, rest);
  }
  return fmt::format("{:.2g} ({}) to {:.2g} ({}), estimated {}; {}", lower,
                     window["lower_from"].get<std::string>(), upper,
                     window["upper_from"].get<std::string>(), step, rest);
}

/// `all`: what the operations are a share of, with its name.
std::string elimination_text(const json& found, double all, const char* name) {
  if (found.is_null()) return "not computed, it is too much work";
  const auto factor = found["factor_nonzeros"].get<long>();
  const double mean = found["per_column"], flops = found["flops"];
  return fmt::format(
      "{} non-zeros of L, {:.3g} a column, {} at most; {:.3g} operations, {:.3g} % of {}; "
      "tree of height {}; {} supernodes",
      factor, mean, found["widest"].get<int>(), flops, 100 * flops / std::max(all, 1.0), name,
      found["height"].get<int>(), found["supernodes"].get<int>());
}

}  // namespace

std::string text_line(const std::string& label, const std::string& text) {
  return fmt::format("{:<22}{}\n", label, text);
}

std::string listed(const json& names) {
  constexpr std::size_t kMost = 8;
  std::vector<std::string> first;
  for (std::size_t i = 0; i < std::min(names.size(), kMost); ++i) first.push_back(names[i]);
  const std::string text = fmt::format("{}", fmt::join(first, ", "));
  return names.size() > kMost ? fmt::format("{} and {} more", text, names.size() - kMost) : text;
}

std::string assembly_text(const json& assembly) {
  const double position = assembly["position_correction"];
  const double velocity = assembly["velocity_correction"];
  const std::string point = assembly["point"];
  std::vector<std::string> changes;
  if (position > 0.0) {
    changes.push_back(fmt::format("points moved by up to {:.3g} m ({})", position, point));
  }
  if (velocity > 0.0) {
    changes.push_back(fmt::format("velocities changed by up to {:.3g} m/s", velocity));
  }
  return changes.empty() ? "consistent as given" : fmt::format("{}", fmt::join(changes, ", "));
}

std::string describe_text(const json& d) {
  std::string text = text_line("scene", d["scene"]);
  text += text_line("coordinates n", points_text(d));
  text += text_line("constraints m", fmt::format("{}", d["constraints"].get<int>()));
  text += text_line("degrees of freedom", freedom_text(d));
  text += text_line("redundant", redundant_text(d));
  text += text_line("start", start_text(d));
  text += text_line("assembly", assembly_text(d["assembly"]));
  text += text_line("terms present", term_list(d["terms"], true));
  text += text_line("terms absent", term_list(d["terms"], false));
  text += text_line("mass matrix M", matrix_text(d["mass"], "n^2"));
  text += text_line("Jacobian", matrix_text(d["jacobian"], "m n"));
  text += text_line("tangent", matrix_text(d["tangent"], "n^2"));
  const json& orderings = d["elimination"]["orderings"];
  const double n = d["variables"], m = d["constraints"];
  for (const auto& [label, ordering] :
       {std::pair{"elimination, AMD", "AMD"}, std::pair{"  as given", "natural"}}) {
    text += text_line(label, elimination_text(orderings[ordering], full_flops(n), "a full L's"));
  }
  const double of_dense = dense_saddle_flops(n, m, d["features"]["stiff"] == 1);
  text += text_line("  saddle-point matrix",
                    elimination_text(orderings["saddle-point"], of_dense, "a dense solver's"));
  const json& assumed = d["passes"]["assumed"];
  text += text_line(
      "passes a step",
      fmt::format("about {:.3g}, {:.3g} in the saddle-point form{}",
                  d["passes"]["penalty"].get<double>(), d["passes"]["saddle-point"].get<double>(),
                  assumed.empty()
                      ? ""
                      : fmt::format(" (assumed, not counted: {})",
                                    fmt::join(assumed.get<std::vector<std::string>>(), ", "))));
  text += text_line("length l", length_text(d));
  text += text_line("penalty factor", penalty_text(d["penalty_window"]));
  for (const json& warning : d["warnings"]) text += text_line("warning", warning);
  if (const json& fill = d["artificial_fill"]; !fill.is_null()) {
    const auto percent = [&fill](const char* key) { return 100.0 * fill[key].get<double>(); };
    text += text_line(
        "artificial fill",
        fmt::format("asked {:.4g} %, natural {:.4g} %, reached {:.4g} %, seed {}", percent("asked"),
                    percent("natural"), percent("reached"), fill["seed"].get<std::uint64_t>()));
  }
  return text;
}

}  // namespace mbs
