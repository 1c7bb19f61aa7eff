// Small scenes: "The step" of paper/README.md with everything dense, in double precision.
#pragma once

#include <memory>
#include <type_traits>

#include "mbs/simulation.hpp"
#include "small/drivers.hpp"
#include "small/factors.hpp"
#include "small/forces.hpp"

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
  void project(double* x, const double* v, const double* given);

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

template <int N, int D>
StepOutcome SmallStepper<N, D>::do_step() {
  phases_.enter(Phase::other);
  if (drivers_.any()) {
    gravity_.put(force_.data());
    drivers_.drive(time(), q_.data(), v_.data(), a_.data(), constraints_.values.data(),
                   force_.data());
  }
  predict();
  StepOutcome outcome;
  outcome.status = StepStatus::pass_limit;
  for (int pass = 1; pass <= settings_.max_passes; ++pass) {
    outcome.passes = pass;
    phases_.enter(Phase::evaluation);
    linearize(pass == 1 ? 0.0 : settings_.penalty);
    phases_.enter(Phase::factorization);
    Row change;
    if (!factors_.factorize_and_solve(matrix_, y_, change)) {
      outcome.status = StepStatus::factorization_failed;
      return outcome;
    }
    phases_.enter(Phase::other);
    apply(change);
    if (change.is_within(settings_.tolerance)) {
      outcome.status = StepStatus::converged;
      break;
    }
  }
  project();
  phases_.enter(Phase::evaluation);
  constraints_.template evaluate<false>(q_.data(), settings_.penalty, matrix_, y_);
  return outcome;
}

/// Eq. (2) on the difference that is left after rounding, so that v and a follow what q does.
template <int N, int D>
void SmallStepper<N, D>::predict() {
  const double step = settings_.step, to_v = 2.0 / step, to_a = 1.0 / h_, damped = 4.0 / step;
  const Row q = Row::of(q_.data()), v = Row::of(v_.data()), a = Row::of(a_.data());
  Row moved, rate, acceleration;
  for (int r = 0; r < Row::kVectors; ++r) {
    moved.v[r] = q.v[r] + (step * v.v[r] + step * step / 2.0 * a.v[r]);
    const auto difference = moved.v[r] - q.v[r];
    rate.v[r] = to_v * difference - v.v[r];
    acceleration.v[r] = to_a * difference - damped * v.v[r] - a.v[r];
  }
  moved.put(q_.data());
  rate.put(v_.data());
  acceleration.put(a_.data());
}

template <int N, int D>
void SmallStepper<N, D>::linearize(double change) {
  std::conditional_t<kInRegisters<N>, Matrix, Matrix&> matrix = matrix_;
#pragma GCC unroll 16
  for (int j = 0; j < N; ++j) matrix.column[j] = constants_.column[j];
  Row y = Row::zero();
  forces_.add(q_.data(), v_.data(), matrix, y);
  constraints_.template evaluate<true>(q_.data(), change, matrix, y);
  Row inertia[2] = {Row::of(force_.data()), Row::zero()};  // two, for latency
#pragma GCC unroll 16
  for (int j = 0; j < N; ++j) inertia[j % 2].add(-a_[j], mass_.column[j]);
  y.add(h_, inertia[0]);
  y.add(h_, inertia[1]);
  if (kInRegisters<N>) matrix_ = matrix;
  y_ = y;
}

template <int N, int D>
void SmallStepper<N, D>::apply(const Row& change) {
  const double to_v = 2.0 / settings_.step, to_a = to_v * to_v;
  Row q = Row::of(q_.data()), v = Row::of(v_.data()), a = Row::of(a_.data());
  q.add(1.0, change);
  v.add(to_v, change);
  a.add(to_a, change);
  q.put(q_.data());
  v.put(v_.data());
  a.put(a_.data());
}

template <int N, int D>
void SmallStepper<N, D>::project() {
  if (settings_.projections == Projections::none) return;
  if (++unprojected_ < settings_.projections_every) return;
  unprojected_ = 0;
  phases_.enter(Phase::projection);
  factors_.prepare();
  project(v_.data(), nullptr, drivers_.rates());
  if (settings_.projections == Projections::velocity) return;
  project(a_.data(), v_.data(), drivers_.accelerations());
}

/// Eq. (6) for what it changes, as Stepper::project_once().
template <int N, int D>
void SmallStepper<N, D>::project(double* x, const double* v, const double* given) {
  Row y = Row::zero();
  constraints_.project(x, v, given, y);
  Row corrected = Row::of(x);
  corrected.add(1.0, factors_.solve(y));
  corrected.put(x);
}

/// Of the first of the sizes N, More that the model fits in; nothing if it is larger than all.
template <int D, int N, int... More>
std::unique_ptr<Simulation> create_of_size(const Model& model, const StepSettings& settings) {
  if (model.variables() <= N) return std::make_unique<SmallStepper<N, D>>(model, settings);
  if constexpr (sizeof...(More) > 0) return create_of_size<D, More...>(model, settings);
  return nullptr;
}

/// Nothing if the model has more than 16 rows.
std::unique_ptr<Simulation> create_up_to_16(const Model& model, const StepSettings& settings);

}  // namespace mbs::compiled_ldl
