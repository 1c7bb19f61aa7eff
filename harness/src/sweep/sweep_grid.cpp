// A lane's number, written with the axes' lengths as bases, is its place on each axis.
#include "sweep/sweep_grid.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "printable.hpp"
#include "scene_file/load_scene.hpp"
#include "scene_file/parameters.hpp"
#include "sweep/scene_number.hpp"
#include "sweep/value_range.hpp"
#include "usage_error.hpp"

namespace mbs {

SweepGrid::SweepGrid(const std::string& scene, const std::vector<std::string>& vary,
                     const Sampling& sampling)
    : name_(scene), document_(load_document(scene)), base_(scene_of(document_, name_)) {
  for (const std::string& text : vary) add_axis(text);
  require_effect();
  add_samples(sampling);
}

void SweepGrid::add_axis(const std::string& text) {
  const auto equals = text.rfind('=');  // a name may have one, a range has none
  if (equals == std::string::npos || equals == 0) {
    throw UsageError(fmt::format("--vary: found {}, allowed is PATH=RANGE", in_quotes(text)));
  }
  const std::string path = text.substr(0, equals), range = text.substr(equals + 1);
  SweepAxis axis{path, find_number(document_, path), {}, parse_distribution(range, path)};
  for (const SweepAxis& other : axes_) {
    if (other.number != axis.number) continue;
    refuse_vary(path, "the same number as --vary " + in_quotes(other.path), "once");
  }
  if (!axis.distribution) {
    axis.values = parse_range(range, path);
    multiply_lanes(static_cast<long>(axis.values.size()), "--vary " + in_quotes(path));
  }
  axes_.push_back(std::move(axis));
}

/// Numbers in the place of expressions may leave a parameter unused; whoever varies that one as
/// well would see a result that does not depend on it.
void SweepGrid::require_effect() const {
  nlohmann::json document = document_;
  for (const SweepAxis& axis : axes_) document[axis.number] = 0.0;
  for (const std::string& name : unused_parameters(document, name_)) {
    const auto parameter = nlohmann::json::json_pointer("/parameters") / name;
    const auto varied = std::ranges::find(axes_, parameter, &SweepAxis::number);
    if (varied == axes_.end()) continue;
    std::vector<std::string> others;
    for (const SweepAxis& other : axes_) {
      const bool is_replaced = is_expression(document_.at(other.number));
      if (is_replaced && other.number != parameter) others.push_back(in_quotes(other.path));
    }
    refuse_vary(varied->path,
                fmt::format("a parameter that nothing uses where --vary {} puts numbers",
                            fmt::join(others, ", ")),
                "one that an expression still names");
  }
}

void SweepGrid::multiply_lanes(long count, const std::string& option) {
  if (count > kMostLanes / lanes_) {
    throw UsageError(
        fmt::format("{}: found more than {} lanes, allowed are that many", option, kMostLanes));
  }
  lanes_ *= count;
}

void SweepGrid::add_samples(const Sampling& sampling) {
  const auto is_sampled = [](const SweepAxis& axis) { return axis.distribution.has_value(); };
  const auto sampled = static_cast<std::size_t>(std::ranges::count_if(axes_, is_sampled));
  if ((sampled == 0) != (sampling.count == 0)) {
    throw UsageError(sampled == 0 ? "--sample: found no number to sample, allowed with --vary "
                                    "PATH=uniform:a:b or PATH=normal:mean:deviation"
                                  : "--vary: found a distribution, allowed with --sample N");
  }
  if (sampled == 0) return;
  multiply_lanes(samples_ = sampling.count, "--sample");
  auto shares = draw_shares(sampled, sampling);
  auto next = shares.begin();
  for (SweepAxis& axis : axes_) {
    if (axis.distribution) axis.values = std::move(*next++);
  }
}

std::vector<double> SweepGrid::values(long lane) const {
  std::vector<double> result(axes_.size());
  const auto sample = static_cast<std::size_t>(lane % samples_);
  lane /= samples_;
  for (std::size_t i = axes_.size(); i-- > 0;) {
    if (axes_[i].distribution) {
      result[i] = value_at(*axes_[i].distribution, axes_[i].values[sample]);
      continue;
    }
    const auto count = static_cast<long>(axes_[i].values.size());
    result[i] = axes_[i].values[static_cast<std::size_t>(lane % count)];
    lane /= count;
  }
  return result;
}

Scene SweepGrid::scene(long lane) const {
  if (varied_.is_null()) varied_ = document_;
  const std::vector<double> changed = values(lane);
  for (std::size_t i = 0; i < axes_.size(); ++i) varied_[axes_[i].number] = changed[i];
  return scene_of(varied_, name_, Unused::allowed);  // base_ was looked at
}

std::string SweepGrid::describe(long lane) const {
  const std::vector<double> changed = values(lane);
  std::vector<std::string> parts;
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    parts.push_back(fmt::format("{} = {}", printable(axes_[i].path), changed[i]));
  }
  return fmt::format("lane {} of {} ({})", lane + 1, lanes_, fmt::join(parts, ", "));
}

}  // namespace mbs
