// A lane's number, written with the axes' lengths as bases, is its place on each axis.
#include "sweep/sweep_grid.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "printable.hpp"
#include "scene_file/load_scene.hpp"
#include "sweep/scene_number.hpp"
#include "sweep/value_range.hpp"
#include "usage_error.hpp"

namespace mbs {

SweepGrid::SweepGrid(const std::string& scene, const std::vector<std::string>& vary)
    : name_(scene), document_(load_document(scene)), base_(scene_of(document_, name_)) {
  for (const std::string& text : vary) add_axis(text);
}

void SweepGrid::add_axis(const std::string& text) {
  const auto equals = text.rfind('=');  // a name may have one, a range has none
  if (equals == std::string::npos || equals == 0) {
    throw UsageError(fmt::format("--vary: found {}, allowed is PATH=RANGE", in_quotes(text)));
  }
  const std::string path = text.substr(0, equals);
  SweepAxis axis{path, find_number(document_, path), parse_range(text.substr(equals + 1), path)};
  for (const SweepAxis& other : axes_) {
    if (other.number != axis.number) continue;
    refuse_vary(path, "the same number as --vary " + in_quotes(other.path), "once");
  }
  const auto count = static_cast<long>(axis.values.size());
  if (count > kMostLanes / lanes_) {
    throw UsageError(fmt::format("--vary {}: found more than {} lanes, allowed are that many",
                                 in_quotes(path), kMostLanes));
  }
  lanes_ *= count;
  axes_.push_back(std::move(axis));
}

std::vector<double> SweepGrid::values(long lane) const {
  std::vector<double> result(axes_.size());
  for (std::size_t i = axes_.size(); i-- > 0;) {
    const auto count = static_cast<long>(axes_[i].values.size());
    result[i] = axes_[i].values[static_cast<std::size_t>(lane % count)];
    lane /= count;
  }
  return result;
}

Scene SweepGrid::scene(long lane) const {
  nlohmann::json document = document_;
  const std::vector<double> changed = values(lane);
  for (std::size_t i = 0; i < axes_.size(); ++i) document[axes_[i].number] = changed[i];
  return scene_of(document, name_);
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
