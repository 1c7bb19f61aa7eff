// Small scenes: "The step" of paper/README.md with everything dense, in double precision.
#pragma once

#include <type_traits>

#include "mbs/simulation.hpp"
#include "small_drivers.hpp"
#include "small_factors.hpp"
#include "small_forces.hpp"

namespace mbs::compiled_ldl {

/// N >= variables. With few rows latency decides: elements add whole rows to a matrix in registers
/// rather than entries to one in memory, and no list of places is gone through.
template <int N, int D>
class SmallStepper final : public Simulation {
 public:
  SmallStepper(const Model& model, const StepSettings& settings);

 protected:
  void do_set_state(const State& state) override;
  StepOutcome do_step() override;
  void do_get_state(State& state) const override;

 private:
  using Row = SmallRow<N>;
  using Matrix = SmallMatrix<N>;

  void predict();
  /// Eqs. (3) and (5) at q', after λ += change Φ.
  void linearize(double change);
  void apply(const Row& change);
  void project();
  void project(double* x, const double* v, const Prescribed* prescribed);

  StepSettings settings_;
  int variables_;
  double h_;  // Δt²/4
  SmallConstraints<N, D> constraints_;
  SmallForces<N, D> forces_;
  SmallDrivers<N, D> drivers_;
  SmallFactors<N> factors_;
  Matrix mass_, constants_, matrix_;
  Row gravity_, y_;
  Array<double> force_, q_, v_, a_;
  int unprojected_ = 0;  // steps since the last projection
};

template <int N, int D>
SmallStepper<N, D>::SmallStepper(const Model& model, const StepSettings& settings)
    : Simulation(model, settings),
      settings_(settings),
      variables_(model.variables()),
      h_(settings.step * settings.step / 4.0),
      constraints_(model, settings.penalty, h_),
      forces_(model, settings.step),
      drivers_(model),
      gravity_(Row::zero()) {
  const auto extent = Difference<N, D>::extent(model);
  for (auto* x : {&q_, &v_, &a_, &force_}) x->resize(extent, 0.0);
  for (int i = 0; i < static_cast<int>(model.points().size()); ++i) {
    if (!model.points()[i].is_fixed()) continue;
    std::copy_n(model.points()[i].position.begin(), D, &q_[Difference<N, D>::place(model, i)]);
  }
  std::vector<double> entries(N * Row::kSize, 0.0);
  for (const MassEntry& entry : model.mass()) {
    entries[entry.col * Row::kSize + entry.row] = entry.value;
    entries[entry.row * Row::kSize + entry.col] = entry.value;
  }
  mass_ = Matrix::of(entries.data());
  for (int i = variables_; i < N; ++i) entries[i * Row::kSize + i] = 1.0;  // rows without a use
  constants_ = Matrix::of(entries.data());
  constraints_.add_constant(constants_);
  std::copy(model.force().begin(), model.force().end(), force_.begin());
  gravity_ = Row::of(force_.data());
}

template <int N, int D>
void SmallStepper<N, D>::do_set_state(const State& state) {
  std::copy(state.q.begin(), state.q.end(), q_.begin());
  std::copy(state.v.begin(), state.v.end(), v_.begin());
  std::copy(state.a.begin(), state.a.end(), a_.begin());
  std::copy(state.lambda.begin(), state.lambda.end(), constraints_.lambda.begin());
  unprojected_ = 0;
}

template <int N, int D>
void SmallStepper<N, D>::do_get_state(State& state) const {
  std::copy_n(q_.begin(), variables_, state.q.begin());
  std::copy_n(v_.begin(), variables_, state.v.begin());
  std::copy_n(a_.begin(), variables_, state.a.begin());
  std::copy(constraints_.lambda.begin(), constraints_.lambda.end(), state.lambda.begin());
}

}  // namespace mbs::compiled_ldl

#include "small_passes.hpp"
