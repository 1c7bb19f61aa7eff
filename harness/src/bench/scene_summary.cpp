// Lays out the summary of a scene.
#include "bench/scene_summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <thread>
#include <utility>

#include "bench/paired_ratio.hpp"
#include "bench/scene_lines.hpp"
#include "registry/registry.hpp"

namespace mbs {
namespace {

/// Columns of a terminal: bytes that begin a character.
std::size_t columns(const std::string& text) {
  return static_cast<std::size_t>(std::ranges::count_if(
      text, [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

}  // namespace

std::string filled(const std::string& text) {
  constexpr std::size_t kColumns = 80;
  std::string result, line;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find(' ', begin), text.size());
    const std::string word = text.substr(begin, end - begin);
    if (!line.empty() && columns(line) + 1 + columns(word) > kColumns) {
      result += line + "\n";
      line = "   ";
    }
    if (begin > 0) line += " ";
    line += word;
    begin = end + 1;
  }
  return result + line + "\n";
}

namespace {

/// Names by what is said of them, in the order in which it is first said.
class NamesByReason {
 public:
  void add(const std::string& reason, const std::string& name) {
    auto found = std::ranges::find(groups_, reason, &Group::first);
    if (found == groups_.end()) found = groups_.insert(found, {reason, ""});
    found->second += (found->second.empty() ? "" : ", ") + name;
  }
  [[nodiscard]] std::string text(const std::string& title) const {
    if (groups_.empty()) return "";
    std::string result = title + "\n";
    for (const auto& [reason, names] : groups_)
      result += filled(fmt::format("  {}: {}", reason, names));
    return result;
  }

 private:
  using Group = std::pair<std::string, std::string>;
  std::vector<Group> groups_;
};

std::string summary_heading(const SceneResult& scene) {
  const PlannedScene& planned = *scene.scene;
  const Stretch& stretch = planned.stretch;
  return filled(fmt::format("{}: {} variables, {} constraints, tangent filled to {:.3g} %",
                            planned.scene.name, planned.scene.model.variables(),
                            planned.scene.model.constraints(), planned.fill_percent)) +
         filled(fmt::format("{} steps of {:g} ms from t = {:.6g} s, {} sample{} of each",
                            stretch.steps, 1e3 * planned.settings.step, stretch.start,
                            scene.samples, scene.samples == 1 ? "" : "s"));
}

bool as_fast(const ContenderLine& line, const ContenderLine& fastest) {
  constexpr double kConfidence = 0.95;
  if (&line == &fastest) return false;
  const PairedRatio ratio = paired_ratio(line.times, fastest.times);
  return ratio.confidence >= kConfidence && ratio.high <= kAsFast;
}

std::string summary_line(const ContenderLine& line, const ContenderLine* fastest, std::size_t width,
                         int steps) {
  const bool ranked = line.ranked() && fastest != nullptr;
  const std::string ratio = !ranked            ? "-"
                            : &line == fastest ? "1"
                                               : paired_ratio_text(line, *fastest);
  std::string text = fmt::format(
      "{:<{}}  {:<3} {:>9}  {:<22} {:>6.3f}{}", line.name, width,
      line.ranked() && line.contender->cell->own_code ? "own" : "",
      line.middle < 1e4 ? fmt::format("{:.4g}", line.middle) : fmt::format("{:.0f}", line.middle),
      ratio, static_cast<double>(line.contender->figures.passes) / steps,
      ranked && as_fast(line, *fastest) ? "  as fast" : "");
  return text + "\n";
}

std::string share_lines(const std::vector<ContenderLine>& lines, std::size_t width) {
  constexpr std::array<const char*, kPhaseCount> kNames{"evaluate", "assemble", "factor",
                                                        "solve",    "project",  "other"};
  std::string text = fmt::format("\n{:<{}} ", "shares of the time, %", width);
  for (const char* name : kNames) text += fmt::format(" {:>8}", name);
  text += "\n";
  bool any = false;
  for (const ContenderLine& line : lines) {
    if (!line.ranked() || !line.contender->figures.phases) continue;
    any = true;
    text += fmt::format("{:<{}} ", line.name, width);
    for (const double share : *line.contender->figures.phases) {
      text += fmt::format(" {:>8.1f}", 100 * share);
    }
    text += "\n";
  }
  return any ? text : "";
}

/// The fastest of a layer and who is as fast; empty if nobody of it was timed.
std::string layer_winner(const std::vector<ContenderLine>& lines, bool own_code) {
  const auto in_layer = [own_code](const ContenderLine& line) {
    return line.ranked() && line.contender->cell->own_code == own_code;
  };
  const auto fastest = std::ranges::find_if(lines, in_layer);
  if (fastest == lines.end()) return "";
  std::string text = fmt::format(
      "{} {}, {:.4g} µs a step",
      own_code ? "fastest own code:" : "fastest library: ", fastest->name, fastest->middle);
  std::string also;
  for (const ContenderLine& line : lines) {
    if (in_layer(line) && as_fast(line, *fastest)) also += (also.empty() ? "" : ", ") + line.name;
  }
  return filled(text + (also.empty() ? "" : "; as fast: " + also));
}

/// Without what only this contender's own numbers say, if it is merely slow.
std::string reason_of(const ContenderResult& contender) {
  return contender.slower() ? contender.failure.substr(0, contender.failure.rfind(" ("))
                            : contender.failure;
}

std::string busy_note(const SceneResult& scene, double load) {
  // By the load's mean over a minute, with what is timed here: from half of the processors on.
  const double busy = std::max(1.5, std::thread::hardware_concurrency() / 2.0);
  const double factor = clock_factor(scene);
  if (factor <= kCalm && load <= busy) return "";
  std::string what;
  if (factor > kCalm) what = fmt::format("by the clock, steps took {:.2f} times as long", factor);
  if (load >= 0.0) what += fmt::format("{}load {:.1f}", what.empty() ? "" : ", ", load);
  return filled(fmt::format("The machine was busy: {}; ratios hold, times do not.", what));
}

}  // namespace

std::string scene_summary(const SceneResult& scene, double load) {
  const std::vector<ContenderLine> lines = contender_lines(scene);
  std::size_t width = std::string_view("shares of the time, %").size();
  NamesByReason left_out;
  for (const ContenderLine& line : lines) {
    if (line.contender->timed()) {
      width = std::max(width, line.name.size());
    } else {
      left_out.add(reason_of(*line.contender), line.name);
    }
  }
  const auto fastest = std::ranges::find_if(lines, &ContenderLine::ranked);
  const ContenderLine* base = fastest == lines.end() ? nullptr : &*fastest;
  std::string text = summary_heading(scene);
  if (scene.samples > 0) {
    text += fmt::format("{:<{}}      {:>9}  {:<22} {:>6}\n", "", width, "µs a step",
                        "to the fastest", "passes");
  }
  for (const ContenderLine& line : lines) {
    if (line.contender->timed()) {
      text += summary_line(line, base, width, scene.scene->stretch.steps);
    }
  }
  text += share_lines(lines, width);
  if (base != nullptr) text += "\n" + layer_winner(lines, false) + layer_winner(lines, true);
  text += busy_note(scene, load);
  return text + left_out.text("left out:") + "\n";
}

std::string unavailable_summary() {
  NamesByReason missing;
  for (const RegistryEntry& entry : registry()) {
    if (!entry.unavailable.empty()) missing.add(entry.unavailable, entry.folder);
  }
  const std::string text = missing.text("not in this build:");
  return text.empty() ? "" : text + "\n";
}

std::string summary_footer() {
  return "To the fastest: median of the ratios of samples taken side by side, and its\n"
         "95 % interval (below 6 samples: the least and the largest). Another process\n"
         "differs. As fast: at most 5 % longer, by that interval. Own: own code, on no\n"
         "library. Times are the processor's. Set-up times and errors: --no-summary.\n";
}

}  // namespace mbs
