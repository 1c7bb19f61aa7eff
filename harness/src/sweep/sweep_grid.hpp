// The lanes of a sweep: every combination of the values that are varied.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "scene/scene.hpp"

namespace mbs {

/// One number of the scene and what it is to be.
struct SweepAxis {
  std::string path;  ///< as typed
  nlohmann::json::json_pointer number;
  std::vector<double> values;
};

/// The full grid over the axes; the last one varies fastest.
///
///   SweepGrid grid("pendulum.json", {"masses/B/mass=1:3:3", "gravity/1=-9.81,-1.62"});
///   grid.lanes() == 6;  grid.values(1) == {1.0, -1.62};  Scene scene = grid.scene(1);
class SweepGrid {
 public:
  /// `vary` has PATH=RANGE of find_number() and parse_range(). Throws UsageError, also on more than
  /// kMostLanes lanes and on a number that is varied twice.
  SweepGrid(const std::string& scene, const std::vector<std::string>& vary);

  [[nodiscard]] long lanes() const { return lanes_; }
  [[nodiscard]] const std::vector<SweepAxis>& axes() const { return axes_; }
  /// As it is without the sweep.
  [[nodiscard]] const Scene& base() const { return base_; }
  /// One an axis.
  [[nodiscard]] std::vector<double> values(long lane) const;
  /// Throws UsageError where these values make no scene.
  [[nodiscard]] Scene scene(long lane) const;
  /// "lane 2 of 6 (masses/B/mass = 1, gravity/1 = -1.62)", for people.
  [[nodiscard]] std::string describe(long lane) const;

 private:
  void add_axis(const std::string& text);

  std::string name_;
  nlohmann::json document_;
  Scene base_;
  std::vector<SweepAxis> axes_;
  long lanes_ = 1;
};

}  // namespace mbs
