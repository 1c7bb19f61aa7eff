// What the predictor and the last multipliers leave to the first pass, extrapolated.
#include "describe/passes.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "model_math/kinematics.hpp"
#include "run/driver_end.hpp"
#include "run/initial_state.hpp"
#include "run/settings.hpp"
#include "run/stretch.hpp"

namespace mbs {
namespace {

constexpr int kApart = 8;  // steps between the states that rates are taken from

/// How fast a value changes, as a straight line through three of its values.
class Rate {
 public:
  /// Values at 0, `apart` and 2 `apart`.
  Rate(double first, double second, double third, double apart)
      : slope_((third - 2 * second + first) / (apart * apart)),
        start_((second - first) / apart - slope_ * apart / 2) {}

  [[nodiscard]] double at(double t) const { return std::abs(start_ + slope_ * t); }

 private:
  double slope_, start_;
};

/// The state at `t` from the start, as if accelerations stayed.
State later(const Model& model, const State& start, double t) {
  std::vector<double> q = start.q, v = start.v;
  for (std::size_t i = 0; i < q.size(); ++i) {
    q[i] += t * v[i] + t * t / 2 * start.a[i];
    v[i] += t * start.a[i];
  }
  return consistent_state(model, q, v, start.t + t);
}

std::vector<double> row_lengths(const Model& model, const State& state) {
  std::vector<double> result(state.lambda.size(), 0.0);
  for (const JacobianEntry& entry : jacobian(model, state.t, state.q)) {
    double& length = result[static_cast<std::size_t>(entry.row)];
    length = std::hypot(length, entry.value);
  }
  return result;
}

std::vector<Rate> rates(const std::vector<double>& first, const std::vector<double>& second,
                        const std::vector<double>& third, double apart) {
  std::vector<Rate> result;
  for (std::size_t i = 0; i < first.size(); ++i) {
    result.emplace_back(first[i], second[i], third[i], apart);
  }
  return result;
}

}  // namespace

Passes expected_passes(const Scene& scene, double smallest, const StepSettings& settings) {
  const Model& model = scene.model;
  const double step = settings.step, apart = kApart * step;
  if (driver_end(model) < 2 * apart) return {};
  // Elsewhere a stretch begins at the start, and is refused if drivers are too fast for the step.
  const State start = scene.four_bar_loops ? make_stretch(scene, step, kPassSteps).initial
                                           : initial_state(model);
  const State second = later(model, start, apart), third = later(model, start, 2 * apart);
  const std::vector<Rate> jerk = rates(start.a, second.a, third.a, apart);
  const std::vector<Rate> pull = rates(start.lambda, second.lambda, third.lambda, apart);
  const std::vector<double> length = row_lengths(model, start);

  StepSettings penalty = settings, saddle_point = settings;
  penalty.scheme = Scheme::penalty;
  saddle_point.scheme = Scheme::saddle_point;
  for (StepSettings* form : {&penalty, &saddle_point}) {
    form->penalty = automatic_penalty(model, *form, smallest);
    form->tolerance = automatic_tolerance(model, *form);
  }
  int more_of_penalty = 0, more_of_saddle_point = 0;  // steps with a second pass
  for (int k = 0; k < kPassSteps; ++k) {
    const double t = (k + 0.5) * step;
    double moved = 0.0, stretched = 0.0;  // m: by the first pass; by what the multipliers lag
    for (const Rate& one : jerk) moved = std::max(moved, one.at(t) * std::pow(step, 3) / 4);
    for (std::size_t i = 0; i < pull.size(); ++i) {
      stretched = std::max(stretched, pull[i].at(t) * step / (penalty.penalty * length[i]));
    }
    more_of_penalty += std::max(moved, stretched) > penalty.tolerance ? 1 : 0;
    more_of_saddle_point += moved > saddle_point.tolerance ? 1 : 0;
  }
  return {1.0 + static_cast<double>(more_of_penalty) / kPassSteps,
          1.0 + static_cast<double>(more_of_saddle_point) / kPassSteps};
}

}  // namespace mbs
