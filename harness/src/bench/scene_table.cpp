// Lays out the table of a scene.
#include "bench/scene_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "bench/scene_lines.hpp"

namespace mbs {
namespace {

constexpr std::array<const char*, kPhaseCount> kPhaseNames{
    "evaluation", "assembly", "factorization", "solve", "projection", "other"};

std::string heading(const SceneResult& scene) {
  const PlannedScene& planned = *scene.scene;
  const Stretch& stretch = planned.stretch;
  std::string text = fmt::format(
      "{}: {} variables, {} constraints, tangent filled to {:.3g} %\n"
      "{} steps of {:g} ms from t = {:.6g} s",
      planned.scene.name, planned.scene.model.variables(), planned.scene.model.constraints(),
      planned.fill_percent, stretch.steps, 1e3 * planned.settings.step, stretch.start);
  if (scene.samples == 0) return text + "\n";
  const Turns& turns = scene.turns;
  return text + fmt::format("; {} sample{} of each, {}\n", scene.samples,
                            scene.samples == 1 ? "" : "s",
                            turns.count() > 1 ? fmt::format("in {} turns", turns.count())
                                              : "a turn each, of one or more stretches");
}

std::string ratio_text(const ContenderLine& line, const ContenderLine* fastest) {
  if (fastest == nullptr || line.contender->cell->control) return "-";
  return &line == fastest ? "1" : paired_ratio_text(line, *fastest);
}

std::string timed_line(const ContenderLine& line, const ContenderLine* fastest, std::size_t width,
                       int steps) {
  const CellFigures& figures = line.contender->figures;
  const bool control = line.contender->cell->control;
  return fmt::format(
      "{:<{}} {:>10.4g}  {:<24} {:>10.4g} {:>7.3f}  {}\n", line.name, width, line.middle,
      ratio_text(line, fastest), figures.setup_us, static_cast<double>(figures.passes) / steps,
      !control && figures.position_error ? fmt::format("{:.2e}", *figures.position_error) : "-");
}

/// A remark if the machine had other things to do.
std::string busy_line(const SceneResult& scene) {
  const double factor = clock_factor(scene);
  if (factor <= kCalm) return "";
  return fmt::format("(The machine is busy: by the clock, steps took {:.2f} times as long.)\n",
                     factor);
}

std::string phase_table(const std::vector<ContenderLine>& lines, std::size_t width) {
  std::string text = fmt::format("\n{:<{}}", "shares of the time, %", width);
  for (const char* phase : kPhaseNames) text += fmt::format(" {:>13}", phase);
  text += "\n";
  for (const ContenderLine& line : lines) {
    if (!line.contender->timed() || !line.contender->figures.phases) continue;
    text += fmt::format("{:<{}}", line.name, width);
    for (const double share : *line.contender->figures.phases) {
      text += fmt::format(" {:>13.1f}", 100 * share);
    }
    text += "\n";
  }
  return text;
}

}  // namespace

std::string scene_table(const SceneResult& scene) {
  const std::vector<ContenderLine> lines = contender_lines(scene);
  std::size_t width = std::string_view("shares of the time, %").size();
  for (const ContenderLine& line : lines) width = std::max(width, line.name.size());
  const auto fastest = std::ranges::find_if(lines, &ContenderLine::ranked);
  const ContenderLine* base = fastest == lines.end() ? nullptr : &*fastest;
  std::string text = heading(scene);
  text += fmt::format("{:<{}} {:>10}  {:<24} {:>10} {:>7}  {}\n", "", width, "step, µs",
                      "to the fastest", "set-up, µs", "passes", "error, m");
  bool phases = false;
  for (const ContenderLine& line : lines) {
    const ContenderResult& contender = *line.contender;
    phases = phases || (contender.timed() && contender.figures.phases);
    text += contender.timed() ? timed_line(line, base, width, scene.scene->stretch.steps)
                              : fmt::format("{:<{}}  {}\n", line.name, width, contender.failure);
  }
  text += busy_line(scene);
  return text + (phases ? phase_table(lines, width) : "") + "\n";
}

std::string table_footer() {
  return "step: median over the samples. To the fastest: median of the ratios of samples taken "
         "side "
         "by side,\nwith its 95 % interval (below 6 samples: the least and the largest) within "
         "this "
         "process; what differs\nfrom process to process is not in it. passes: a step. error: of "
         "position, at the end of the stretch.\n";
}

}  // namespace mbs
