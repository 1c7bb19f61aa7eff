// Batches: groups of lanes one after the other.
#include "simulations.hpp"
#include "system.hpp"

namespace mbs::compiled_ldl {

/// Simulations side by side, one a lane: "The step" with each lane stopping at its own pass.
template <int D>
class LaneGroup {
 public:
  LaneGroup(std::span<const Model* const> models, std::span<const StepSettings> settings)
      : settings_(settings[0]),
        tolerance_(of_settings<Lanes>(settings, &StepSettings::tolerance)),
        system_(models, settings) {}

  void set_state(int lane, const State& state) {
    system_.put(lane, state);
    running_[lane] = -1;
    unprojected_ = 0;
  }
  void get_state(int lane, State& state) const { system_.get(lane, state); }
  void retire(int lane) { running_[lane] = 0; }

  /// One step to `time`; outcomes of the lanes that take part.
  void step(double time, std::span<StepOutcome> outcomes);

 private:
  void predict();
  /// Applies the last solution in the lanes of `active`; max|Δq|.
  Lanes apply(const LaneMask& active);
  /// λ += α Φ in the lanes of `corrected`; gradients in those that go on, the others keep theirs
  /// for the projections.
  void update(const LaneMask& corrected, const LaneMask& active);
  void project();
  void project_once(Lanes* x, const Lanes* v, const Lanes* given);

  StepSettings settings_;
  Lanes tolerance_;
  System<Lanes, Lanes, D> system_;
  LaneMask running_{};
  int unprojected_ = 0;
};

template <int D>
void LaneGroup<D>::step(double time, std::span<StepOutcome> outcomes) {
  if (!any(running_)) return;
  if (system_.drivers.any()) system_.drive(time);
  predict();
  system_.evaluate();
  LaneMask active = running_;
  for (int pass = 1; any(active); ++pass) {
    system_.begin_residual();
    system_.finish_residual();
    system_.assemble_where(active);
    system_.factorize_and_solve();
    const LaneMask failed = active & (system_.fronts.least_pivot().v < 0.0);
    const Lanes change = apply(active);
    const LaneMask converged = active & ~failed & (change.v <= tolerance_.v);
    for (int i = 0; i < static_cast<int>(outcomes.size()); ++i) {
      if (active[i] == 0) continue;
      outcomes[i] = {.status = failed[i] != 0      ? StepStatus::factorization_failed
                               : converged[i] != 0 ? StepStatus::converged
                                                   : StepStatus::pass_limit,
                     .passes = pass};
    }
    const LaneMask corrected = active;
    active &= ~(failed | converged);
    if (pass == settings_.max_passes) active = LaneMask{};
    update(corrected, active);
  }
  project();
}

/// As Stepper::predict().
template <int D>
void LaneGroup<D>::predict() {
  Lanes* q = system_.q.data();
  Lanes* v = system_.v.data();
  Lanes* a = system_.a.data();
  const double step = settings_.step;
  const Lanes half = step * step / 2.0, to_v = 2.0 / step, to_a = 4.0 / (step * step);
  for (int i = 0; i < system_.program.size; ++i) {
    const Lanes moved = q[i] + (step * v[i] + half * a[i]);
    const Lanes difference = moved - q[i];
    q[i] = moved;
    a[i] = to_a * difference - 4.0 / step * v[i] - a[i];
    v[i] = to_v * difference - v[i];
  }
}

template <int D>
Lanes LaneGroup<D>::apply(const LaneMask& active) {
  Lanes* q = system_.q.data();
  Lanes* v = system_.v.data();
  Lanes* a = system_.a.data();
  const Lanes to_v = 2.0 / settings_.step, to_a = 4.0 / (settings_.step * settings_.step);
  Lanes most = 0.0, sum = 0.0;
  for (int i = 0; i < system_.program.size; ++i) {
    const Lanes y = select(active, system_.y[i]);
    most = larger(most, magnitude(y));
    sum += 0.0 * y;  // NaN if y is infinite or NaN
    q[i] += y;
    v[i] += to_v * y;
    a[i] += to_a * y;
  }
  return most + sum;
}

template <int D>
void LaneGroup<D>::update(const LaneMask& corrected, const LaneMask& active) {
  auto& s = system_;
  if (any(active)) {
    s.constraints.evaluate_where(active, s.q.data(), s.phi.data());
  } else {
    s.constraints.values(s.q.data(), [&](int k, const Lanes& value) { s.phi[k] = value; });
  }
  for (int k = 0; k < s.constraints.count(); ++k) {
    s.lambda[k] += select(corrected, s.alpha * s.phi[k]);
  }
}

template <int D>
void LaneGroup<D>::project() {
  if (settings_.projections == Projections::none) return;
  if (++unprojected_ < settings_.projections_every) return;
  unprojected_ = 0;
  project_once(system_.v.data(), nullptr, system_.drivers.rates());
  if (settings_.projections == Projections::velocity) return;
  project_once(system_.a.data(), system_.v.data(), system_.drivers.accelerations());
}

/// As Stepper::project_once().
template <int D>
void LaneGroup<D>::project_once(Lanes* x, const Lanes* v, const Lanes* given) {
  auto& s = system_;
  for (int i = 0; i < s.program.size; ++i) s.y[i] = 0.0;
  s.constraints.add_projection(x, v, given, -s.h * s.alpha, s.y.data());
  s.solve();
  for (int i = 0; i < s.program.size; ++i) x[i] += s.y[i];
}

namespace {

template <int D>
class Batch final : public BatchSimulation {
 public:
  Batch(std::span<const Model* const> models, std::span<const StepSettings> settings)
      : BatchSimulation(models, settings) {
    for (std::size_t first = 0; first < models.size(); first += Lanes::kCount) {
      const std::size_t count = std::min<std::size_t>(Lanes::kCount, models.size() - first);
      groups_.push_back(std::make_unique<LaneGroup<D>>(models.subspan(first, count),
                                                       settings.subspan(first, count)));
    }
  }

 protected:
  void do_set_state(int lane, const State& state) override {
    groups_[lane / Lanes::kCount]->set_state(lane % Lanes::kCount, state);
  }
  void do_get_state(int lane, State& state) const override {
    groups_[lane / Lanes::kCount]->get_state(lane % Lanes::kCount, state);
  }
  void do_retire(int lane) override { groups_[lane / Lanes::kCount]->retire(lane % Lanes::kCount); }
  void do_step(std::span<StepOutcome> outcomes) override {
    for (std::size_t i = 0; i < groups_.size(); ++i) {
      const std::size_t first = i * Lanes::kCount;
      const std::size_t count = std::min<std::size_t>(Lanes::kCount, outcomes.size() - first);
      groups_[i]->step(time(), outcomes.subspan(first, count));
    }
  }

 private:
  std::vector<std::unique_ptr<LaneGroup<D>>> groups_;
};

}  // namespace

std::unique_ptr<BatchSimulation> create_batch(std::span<const Model* const> models,
                                              std::span<const StepSettings> settings) {
  const StepSettings& s = settings.front();
  if (s.scheme != Scheme::penalty || s.multipliers != MultiplierUpdate::every_pass ||
      s.tangent != TangentReuse::none || s.precision != Precision::double_precision ||
      s.geometric_stiffness) {
    throw Unsupported(
        "batches are for the penalty form in double precision, multipliers and tangent of every "
        "pass, no geometric stiffness");
  }
  if (models.front()->dimension() == 2) return std::make_unique<Batch<2>>(models, settings);
  return std::make_unique<Batch<3>>(models, settings);
}

}  // namespace mbs::compiled_ldl
