// The state of a simulation and what every scheme does to it.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "layout.hpp"
#include "mbs/model.hpp"
#include "mbs/simulation.hpp"

namespace mbs::eigen_dense {

/// q and v are extended vectors (see Layout), so that fixed points cost nothing in a step.
template <typename Scalar>
struct Motion {
  using Vector = Eigen::VectorX<Scalar>;

  Vector q, v;    ///< extended; m, m/s
  Vector a;       ///< n, m/s²
  Vector lambda;  ///< m

  Motion(const Model& model, const Layout& layout)
      : q(layout.initial_position(model).template cast<Scalar>()),
        v(Vector::Zero(q.size())),
        a(Vector::Zero(model.variables())),
        lambda(Vector::Zero(model.constraints())) {
    std::ranges::copy(model.initial_velocity(), v.begin());
  }

  void set(const State& state) {
    std::ranges::copy(state.q, q.begin());
    std::ranges::copy(state.v, v.begin());
    std::ranges::copy(state.a, a.begin());
    std::ranges::copy(state.lambda, lambda.begin());
  }

  void get(State& state) const {
    std::copy_n(q.begin(), a.size(), state.q.begin());
    std::copy_n(v.begin(), a.size(), state.v.begin());
    std::ranges::copy(a, state.a.begin());
    std::ranges::copy(lambda, state.lambda.begin());
  }

  /// The start of a step of the trapezoidal schemes.
  void predict(Scalar step) {
    Scalar* const q = this->q.data();
    Scalar* const v = this->v.data();
    Scalar* const a = this->a.data();
    const Eigen::Index n = this->a.size();
    for (Eigen::Index i = 0; i < n; ++i) {
      const Scalar predicted = q[i] + step * v[i] + Scalar(0.5) * step * step * a[i];
      const Scalar change = predicted - q[i];
      q[i] = predicted;
      a[i] = 4 / (step * step) * change - 4 / step * v[i] - a[i];  // Eq. (2)
      v[i] = 2 / step * change - v[i];                             // Eq. (2)
    }
  }

  /// Adds Δq (n) to q' and its multiples to v' and a'; whether max|Δq| ≤ tolerance.
  [[nodiscard]] bool correct(const Scalar* delta, Scalar step, Scalar tolerance) {
    const Scalar velocity_factor = 2 / step;
    const Scalar acceleration_factor = 4 / (step * step);
    Scalar* const q = this->q.data();
    Scalar* const v = this->v.data();
    Scalar* const a = this->a.data();
    const Eigen::Index n = this->a.size();
    Eigen::Index beyond = 0;
    for (Eigen::Index i = 0; i < n; ++i) {
      q[i] += delta[i];
      v[i] += velocity_factor * delta[i];            // Eq. (2)
      a[i] += acceleration_factor * delta[i];        // Eq. (2)
      beyond += !(std::abs(delta[i]) <= tolerance);  // so that NaN is beyond it
    }
    return beyond == 0;
  }
};

}  // namespace mbs::eigen_dense
