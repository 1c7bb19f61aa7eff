// Energy of a scene, and of the parts that conserve it where the whole scene does not.
#pragma once

#include <string>
#include <vector>

#include "mbs/model.hpp"
#include "mbs/simulation.hpp"

namespace mbs {

/// The least that a drift of energy is small against, J, whatever moves: a thousandth of the work
/// that the applied forces do over `size` (m) and of what springs hold at `q` (n), where V is
/// `potential` (J); and the energy of a speed that is none.
double least_energy_scale(const Model& model, const std::vector<double>& q, double potential,
                          double size);

/// Energy of a scene or of a part of it; the worst so far and what the next state is judged by.
struct EnergyFigures {
  double reference = 0.0;              // J, at the start; with dampers, the least so far
  double scale = 0.0;                  // J, the largest kinetic energy so far, at least
  double kinetic = 0.0, excess = 0.0;  // J, of the last judged state; what of it is known as wrong
  double farthest = 0.0;               // J, the largest that the energy was off the reference
  double speed = 0.0;                  // m/s, of its fastest point then
  double ahead = 0.0, farthest_ahead = 0.0;  // m; farthest_ahead: the largest |ahead|

  /// Of what `loses` energy only a gain is wrong.
  void judge(double kinetic_now, double potential_now, bool loses);
  /// The way by which `time` (s) with the present excess of energy is ahead or behind. What
  /// one step is ahead by and another behind is no error of both.
  void add(double time);
  /// The farthest over the scale.
  [[nodiscard]] double drift() const { return scale > 0.0 ? farthest / scale : farthest; }
};

/// A driver makes the energy of the whole tell nothing, and a heavy part hides a light one. Parts
/// that no row, mass, spring or law connects with a driver, or with each other, conserve theirs all
/// the same, or lose some if they have dampers.
///
///   PartEnergies parts(model, initial, extent);
///   auto figures = parts.start();
///   parts.judge(t, state, figures);
///   for (auto& part : figures) part.add(64 * 1.25e-3);  // 64 steps like this one
class PartEnergies {
 public:
  /// `initial`: the state at time `start` (s); `size` (m) as least_energy_scale() takes it.
  PartEnergies(const Model& model, const State& initial, double start, double size);

  [[nodiscard]] const std::vector<EnergyFigures>& start() const { return start_; }
  void judge(double t, const State& state, std::vector<EnergyFigures>& figures);
  /// The name of its first point.
  [[nodiscard]] const std::string& name(std::size_t part) const { return parts_[part].name; }

 private:
  struct Part {
    Model model;  // of its points alone, without constraints
    std::string name;
    std::vector<int> cols;
    bool loses = false;  // by dampers alone
    std::vector<double> q, v;
  };
  static void take(const State& state, Part& part);

  std::vector<Part> parts_;
  std::vector<EnergyFigures> start_;
};

}  // namespace mbs
