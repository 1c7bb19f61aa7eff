// Energy of the parts of a scene that conserve it where the whole scene does not.
#pragma once

#include <vector>

#include "mbs/model.hpp"
#include "mbs/simulation.hpp"

namespace mbs {

/// The least that a drift of energy is small against, J, whatever moves: a thousandth of the work
/// that the applied forces do over `size` (m) and of what springs hold at `q` (n), where V is
/// `potential` (J); and the energy of a speed that is none.
double least_energy_scale(const Model& model, const std::vector<double>& q, double potential,
                          double size);

/// A driver or damper makes the energy of the whole tell nothing. Parts that no row, mass, spring
/// or law connects with one conserve theirs all the same.
///
///   PartEnergies parts(model, initial, extent);
///   auto figures = parts.start();
///   parts.judge(t, state, figures);
///   parts.add(1.25e-3, 64, figures);         // 64 steps like this one
class PartEnergies {
 public:
  /// Of one part; the worst so far and what the next state is judged by.
  struct Figures {
    double scale = 0.0;                        // J
    double kinetic = 0.0, difference = 0.0;    // J, of the last judged state
    double speed = 0.0;                        // m/s, of its fastest point there
    double drift = 0.0;                        // largest |difference| over the scale then
    double ahead = 0.0, farthest_ahead = 0.0;  // m, as Judge
  };

  /// `initial`: the state at time `start` (s); `size` (m) as least_energy_scale() takes it.
  PartEnergies(const Model& model, const State& initial, double start, double size);

  [[nodiscard]] const std::vector<Figures>& start() const { return start_; }
  void judge(double t, const State& state, std::vector<Figures>& figures);
  /// What `steps` steps of `step` (s) like the last judged one are ahead by.
  static void add(double step, long steps, std::vector<Figures>& figures);

 private:
  struct Part {
    Model model;  // of its points alone, without constraints
    std::vector<int> cols;
    std::vector<double> q, v;
    double energy = 0.0;  // J, at the start
  };
  static void take(const State& state, Part& part);

  std::vector<Part> parts_;
  std::vector<Figures> start_;
};

}  // namespace mbs
