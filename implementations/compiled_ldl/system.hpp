// The equations of a model on its program: state, residual, matrix, solves.
#pragma once

#include <limits>
#include <memory>
#include <type_traits>

#include "elements/constraints.hpp"
#include "elements/drivers.hpp"
#include "elements/forces.hpp"
#include "elements/mass.hpp"
#include "mbs/simulation.hpp"
#include "panels/fronts.hpp"
#include "panels/panels.hpp"
#include "schur.hpp"

namespace mbs::compiled_ldl {

/// S: numbers of the state; F: of the matrix and its factors.
template <typename S, typename F, int D>
class System {
 public:
  System(std::span<const Model* const> models, std::span<const StepSettings> settings);

  void put(int lane, const State& state);
  void get(int lane, State& state) const;

  void drive(double t);
  void evaluate() { constraints.evaluate(q.data(), phi.data()); }

  void evaluate_and_update() {
    constraints.evaluate_and_update(q.data(), phi.data(), alpha, lambda.data());
  }
  /// λ += α Φ alone; gradients stay.
  void update() {
    constraints.values(q.data(), [&](int k, const S& value) { lambda[k] += alpha * value; });
  }

  /// y = −f of Eq. (3), or the right-hand side of Eq. (12), in two parts: without the forces of the
  /// constraints, and these. assemble() belongs between them, if a pass `renews` the matrix. Then,
  /// where A = M is eliminated once and Q is constant, the points have A⁻¹ of it, h (A⁻¹ Q − a),
  /// and no forces of the constraints: those of h λ + μ are found with the solution.
  void begin_residual(bool renews = true);
  void finish_residual();
  /// The matrix of Eq. (5), (12) or (14), at the last evaluate() and the last forces.
  void assemble();
  /// The matrix of Eq. (5), with the last forces in these lanes only.
  void assemble_where(const LaneMask& mask);
  /// y = solution; false if a pivot was not accepted.
  bool factorize_and_solve();
  void solve();

  /// y = T₀ x, or M x for RATTLE.
  void product(const S* x);
  /// y −= (Δt²/4) α Φqᵀ t, or the multipliers' rows = −t.
  void constrain(const S* t);
  /// The multipliers' rows of y = −t of Constraints::product(), in the saddle-point forms.
  void constrain_rates(const S* x, const S* v, const S* given) {
    S* const to = y.data();
    constraints.rates(x, v, given,
                      [&](int k, const S& rate) { to[constraints.row(k)] = -rate; });
  }
  /// The multipliers' rows of x become zero.
  void clear_multipliers(S* x) const {
    for (int k = 0; k < constraints.count(); ++k) x[constraints.row(k)] = S(0.0);
  }
  /// The multipliers' rows of y = −Φ(q), in the saddle-point forms; gradients stay.
  void constrain_values();
  /// λ or ν += factor times the multipliers' rows of y, which become zero.
  void take_multipliers(S* multipliers, const S& factor);
  /// q' += y, v' += to_v y, a' += y/h; max|y| as below.
  S apply(const S& to_v);
  /// max|y|, NaN if there is one.
  [[nodiscard]] S largest() const;

  Program program;
  Rows rows;
  bool saddle, rattle, curved;
  S alpha, epsilon, h;  // h = Δt²/4
  Constraints<S, D> constraints;
  Drivers<S, D> drivers;
  Forces<S, D> forces;
  Mass<S, D> mass;
  std::conditional_t<kLanesOf<F> == 1, Panels<F>, Fronts<F>> fronts;
  Array<S> q, v, a, force, y;   // extent
  Array<S> lambda, phi, terms;  // constraints

 private:
  static constexpr bool kSame = std::is_same_v<S, F>;
  static constexpr bool kDouble = kSame && std::is_same_v<S, double>;
  void fill_constants();
  void subtract_known_forces();
  S scale_down();
  void scale_up(const S& scale);

  Array<F> rounded_;                 // y in units of its largest entry
  std::unique_ptr<Schur<D>> schur_;  // if the program has constant fronts
  typename Schur<D>::Points points_ = Schur<D>::Points::given;
  Array<S> free_;  // A⁻¹ force
};

// Construction, state in and out.

/// The number that the settings of each lane have.
template <typename S>
S of_settings(std::span<const StepSettings> settings, double StepSettings::*member) {
  S value = static_cast<S>(settings[0].*member);
  for (int i = 1; i < static_cast<int>(settings.size()); ++i) {
    set_lane(value, i, settings[i].*member);
  }
  return value;
}

template <typename S, typename F, int D>
System<S, F, D>::System(std::span<const Model* const> models,
                        std::span<const StepSettings> settings)
    : program(program_of(*models[0], settings[0], kLanesOf<F> == 1 ? 8 : 1)),
      rows(*models[0], program),
      saddle(has_multiplier_rows(settings[0])),
      rattle(is_rattle(settings[0])),
      curved(settings[0].geometric_stiffness),
      alpha(of_settings<S>(settings, &StepSettings::penalty)),
      h(static_cast<S>(settings[0].step * settings[0].step / 4.0)),
      constraints(models, program, rows, saddle, curved),
      drivers(models, rows, constraints),
      forces(models, program, rows, settings[0].step),
      mass(models, program, rows),
      fronts(program, !saddle && !curved) {
  epsilon = S(1.0) / (alpha * h);
  for (auto* x : {&q, &v, &a, &force, &y}) x->resize(rows.extent, S(0.0));
  for (auto* x : {&lambda, &phi, &terms}) x->resize(constraints.count(), S(0.0));
  if (!kSame) rounded_.resize(program.padded, F(0.0));
  for (std::size_t i = 0; i < rows.of_point.size(); ++i) {
    if (rows.is_free(rows.of_point[i])) continue;
    for (int x = 0; x < D; ++x) {
      q[rows.of_point[i] + x] =
          of_models<S>(models, [&](const Model& m) { return m.points()[i].position[x]; });
    }
  }
  fill_constants();
  if constexpr (kDouble) {
    if (program.constant_fronts > 0) {
      schur_ = std::make_unique<Schur<D>>(program, constraints, changing_of(*models[0]), fronts);
    }
  }
  drive(0.0);
}

template <typename S, typename F, int D>
void System<S, F, D>::drive(double t) {
  drivers.drive(t, q.data(), v.data(), a.data(), constraints, force.data());
  if constexpr (kDouble) {
    if (!schur_) return;
    free_ = force;
    schur_->solve_points(free_.data());
  }
}

template <typename S, typename F, int D>
void System<S, F, D>::fill_constants() {
  mass.add_to(fronts.constants());
  constraints.add_constant(fronts.constants(), h * alpha);
  if (!saddle) return;
  for (int k = 0; k < constraints.count(); ++k) {
    const int row = constraints.row(k);
    fronts.constants()[program.entry(row, row)] -= static_cast<F>(epsilon);
  }
}

template <typename S, typename F, int D>
void System<S, F, D>::put(int lane, const State& state) {
  for (std::size_t i = 0; i < state.q.size(); ++i) {
    const int row = rows.of_coordinate[i];
    set_lane(q[row], lane, state.q[i]);
    set_lane(v[row], lane, state.v[i]);
    set_lane(a[row], lane, state.a[i]);
  }
  std::fill(y.begin(), y.end(), S(0.0));  // nothing of a failed step is left behind
  for (int k = 0; k < constraints.count(); ++k) {
    set_lane(lambda[k], lane, state.lambda[constraints.number(k)]);
  }
}

template <typename S, typename F, int D>
void System<S, F, D>::get(int l, State& state) const {
  for (std::size_t i = 0; i < state.q.size(); ++i) {
    const int row = rows.of_coordinate[i];
    state.q[i] = lane(q[row], l);
    state.v[i] = lane(v[row], l);
    state.a[i] = lane(a[row], l);
  }
  for (int k = 0; k < constraints.count(); ++k) {
    state.lambda[constraints.number(k)] = lane(lambda[k], l);
  }
}

// Residual, matrix and solves.

template <typename S, typename F, int D>
void System<S, F, D>::begin_residual([[maybe_unused]] bool renews) {
  if constexpr (kDouble) {
    if (schur_ && renews && !forces.any()) {
      points_ = Schur<D>::Points::solved;
      for (int i = 0; i < program.padded; ++i) y[i] = h * (free_[i] - a[i]);
      return;
    }
  }
  mass.residual(force.data(), a.data(), h, y.data());
  if (forces.any()) forces.add(q.data(), v.data(), h, y.data());
}

/// Comes last, so that the matrix is in the cache when it is factorized.
template <typename S, typename F, int D>
void System<S, F, D>::finish_residual() {
  if (points_ == Schur<D>::Points::solved) {
    for (int k = 0; k < constraints.count(); ++k) {
      y[constraints.row(k)] = -phi[k] - epsilon * h * lambda[k];
    }
    return;
  }
  constraints.add_forces(lambda.data(), phi.data(), saddle ? S(0.0) : alpha, h, y.data());
  if (!saddle) return;
  for (int k = 0; k < constraints.count(); ++k) y[constraints.row(k)] = -phi[k];
}

template <typename S, typename F, int D>
void System<S, F, D>::assemble() {
  if constexpr (kDouble) {
    if (schur_) return schur_->assemble(constraints);
  }
  fronts.start();
  F* matrix = fronts.matrix();
  if (saddle) {
    constraints.add_rows(matrix);
  } else {
    constraints.add_penalty(matrix, h * alpha);
  }
  if (rattle) return;
  if (forces.has_stiffness()) {
    forces.keep();
    forces.add_matrix(matrix);
  }
  if (!curved) return;
  for (int k = 0; k < constraints.count(); ++k) {
    terms[k] = saddle ? lambda[k] : lambda[k] + alpha * phi[k];
  }
  constraints.keep_forces(terms.data(), h);
  constraints.add_curvature(matrix);
}

template <typename S, typename F, int D>
void System<S, F, D>::assemble_where(const LaneMask& mask) {
  fronts.start();
  constraints.add_penalty(fronts.matrix(), h * alpha);
  if (!forces.has_stiffness()) return;
  forces.keep_where(mask);
  forces.add_matrix(fronts.matrix());
}

/// y rounded to F in units of its largest entry, which it returns.
template <typename S, typename F, int D>
S System<S, F, D>::scale_down() {
  S scale = S(0.0);
  for (int i = 0; i < program.padded; ++i) scale = larger(scale, magnitude(y[i]));
  // At rest it shrinks from step to step, until it has no finite inverse: then it counts as zero.
  const S inverse = scale >= std::numeric_limits<S>::min() ? S(1.0) / scale : S(0.0);
  for (int i = 0; i < program.padded; ++i) rounded_[i] = static_cast<F>(y[i] * inverse);
  return scale;
}

template <typename S, typename F, int D>
void System<S, F, D>::scale_up(const S& scale) {
  for (int i = 0; i < program.padded; ++i) y[i] = static_cast<S>(rounded_[i]) * scale;
}

/// Of a solution whose right-hand side had A⁻¹ r at the points, multipliers are h λ + μ.
template <typename S, typename F, int D>
void System<S, F, D>::subtract_known_forces() {
  if (points_ == Schur<D>::Points::given) return;
  points_ = Schur<D>::Points::given;
  for (int k = 0; k < constraints.count(); ++k) y[constraints.row(k)] -= h * lambda[k];
}

template <typename S, typename F, int D>
bool System<S, F, D>::factorize_and_solve() {
  if constexpr (kDouble) {
    if (schur_) {
      const bool accepted = schur_->factorize_and_solve(y.data(), points_);
      subtract_known_forces();
      return accepted;
    }
  }
  if constexpr (kSame) {
    return fronts.factorize_and_solve(y.data());
  } else {
    const S scale = scale_down();
    const bool accepted = fronts.factorize_and_solve(rounded_.data());
    scale_up(scale);
    return accepted;
  }
}

template <typename S, typename F, int D>
void System<S, F, D>::solve() {
  if constexpr (kDouble) {
    if (schur_) {
      schur_->solve(y.data(), points_);
      return subtract_known_forces();
    }
  }
  if constexpr (kSame) {
    fronts.solve(y.data());
  } else {
    const S scale = scale_down();
    fronts.solve(rounded_.data());
    scale_up(scale);
  }
}

template <typename S, typename F, int D>
void System<S, F, D>::product(const S* x) {
  mass.product(x, y.data());
  if (rattle) return;
  if (forces.has_stiffness()) forces.add_product(x, y.data());
  if (curved) constraints.add_curvature_product(x, y.data());
}

template <typename S, typename F, int D>
void System<S, F, D>::constrain(const S* t) {
  if (saddle) {
    for (int k = 0; k < constraints.count(); ++k) y[constraints.row(k)] = -t[k];
    return;
  }
  constraints.add_transposed(t, -h * alpha, y.data());
}

template <typename S, typename F, int D>
void System<S, F, D>::constrain_values() {
  S* const to = y.data();
  constraints.values(q.data(), [&](int k, const S& phi_k) { to[constraints.row(k)] = -phi_k; });
}

template <typename S, typename F, int D>
void System<S, F, D>::take_multipliers(S* multipliers, const S& factor) {
  for (int k = 0; k < constraints.count(); ++k) {
    S& value = y[constraints.row(k)];
    if (multipliers != nullptr) multipliers[k] += factor * value;
    value = S(0.0);
  }
}

/// The largest magnitude of eight numbers at a time and whether all are finite.
template <typename S>
struct Largest {
  S most[8], sum[8];
  Largest() {
    for (int u = 0; u < 8; ++u) most[u] = sum[u] = S(0.0);
  }
  void add(const S* y) {
    for (int u = 0; u < 8; ++u) {
      most[u] = larger(most[u], magnitude(y[u]));
      sum[u] += S(0.0) * y[u];  // NaN if y is infinite or NaN
    }
  }
  [[nodiscard]] S value() const {
    S result = most[0], all = sum[0];
    for (int u = 1; u < 8; ++u) {
      result = larger(result, most[u]);
      all += sum[u];
    }
    return result + all;
  }
};

template <typename S, typename F, int D>
S System<S, F, D>::largest() const {
  Largest<S> largest;
  for (int i = 0; i < program.padded; i += 8) largest.add(y.data() + i);
  return largest.value();
}

template <typename S, typename F, int D>
S System<S, F, D>::apply(const S& to_v) {
  const S to_a = to_v * to_v;
  S* const q_ = q.data();
  S* const v_ = v.data();
  S* const a_ = a.data();
  const S* const y_ = y.data();
  S most = S(0.0), sum = S(0.0);
  const bool few = program.size <= 16;
  for_each_row(program.size, program.padded, [=, &most, &sum](int i) {
    const S change = y_[i];
    q_[i] += change;
    v_[i] += to_v * change;
    a_[i] += to_a * change;
    if (!few) return;
    most = larger(most, magnitude(change));
    sum += S(0.0) * change;
  });
  return few ? most + sum : largest();
}

}  // namespace mbs::compiled_ldl
