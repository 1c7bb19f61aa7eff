// System: residual, matrix and solves. Part of system.hpp.
#pragma once

#include <limits>

#include "system.hpp"

namespace mbs::compiled_ldl {

template <typename S, typename F, int D>
void System<S, F, D>::begin_residual() {
  mass.residual(force.data(), a.data(), h, y.data());
  if (forces.any()) forces.add(q.data(), v.data(), h, y.data());
}

/// Comes last, so that the matrix is in the cache when it is factorized.
template <typename S, typename F, int D>
void System<S, F, D>::finish_residual() {
  constraints.add_forces(lambda.data(), phi.data(), saddle ? S(0.0) : alpha, h, y.data());
  if (!saddle) return;
  for (int k = 0; k < constraints.count(); ++k) y[constraints.row(k)] = -phi[k];
}

template <typename S, typename F, int D>
void System<S, F, D>::assemble() {
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
  constraints.keep_where(mask);
  constraints.add_penalty(fronts.matrix(), h * alpha, true);
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

template <typename S, typename F, int D>
bool System<S, F, D>::factorize_and_solve() {
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
  const S factor = -h * alpha;
  for (int k = 0; k < constraints.count(); ++k) terms[k] = factor * t[k];
  constraints.add_transposed(terms.data(), y.data());
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
