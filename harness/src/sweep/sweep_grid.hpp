// The lanes of a sweep: every combination of the values that are varied.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "scene/scene.hpp"
#include "sweep/sample.hpp"

namespace mbs {

/// One number of the scene and what it is to be.
struct SweepAxis {
  std::string path;  ///< as typed
  nlohmann::json::json_pointer number;
  std::vector<double> values;  ///< of a sampled one: its share of each sample. All lanes' values
                               ///< at once would take longer than a small part of a sweep
  std::optional<Distribution> distribution = std::nullopt;
};

/// The full grid over the axes; the last one varies fastest. Axes that are sampled vary together,
/// faster than all others: every point of the grid has the same samples.
///
///   SweepGrid grid("pendulum.json", {"masses/B/mass=1:3:3", "gravity/1=-9.81,-1.62"});
///   grid.lanes() == 6;  grid.values(1) == {1.0, -1.62};  Scene scene = grid.scene(1);
class SweepGrid {
 public:
  /// `vary` has PATH=RANGE of find_number() and parse_range(). Throws UsageError, also on more than
  /// kMostLanes lanes, on a number that is varied twice and on a parameter that others leave
  /// unused.
  SweepGrid(const std::string& scene, const std::vector<std::string>& vary,
            const Sampling& sampling = {});

  [[nodiscard]] long lanes() const { return lanes_; }
  [[nodiscard]] const std::vector<SweepAxis>& axes() const { return axes_; }
  /// Without what is varied.
  [[nodiscard]] const nlohmann::json& document() const { return document_; }
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
  void require_effect() const;
  void add_samples(const Sampling& sampling);
  void multiply_lanes(long count, const std::string& option);

  std::string name_;
  nlohmann::json document_;
  Scene base_;
  std::vector<SweepAxis> axes_;
  long lanes_ = 1;  // of the grid without samples, then of all
  long samples_ = 1;
  mutable nlohmann::json varied_;  // document_ with the values of the lane that was asked for last
};

}  // namespace mbs
