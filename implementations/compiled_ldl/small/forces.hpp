// Small scenes: applied forces, Eq. (11), with what they add to the matrix.
#pragma once

#include <cmath>

#include "elements/blocks.hpp"
#include "small/rows.hpp"

namespace mbs::compiled_ldl {

template <int N, int D>
class SmallForces {
 public:
  using Row = SmallRow<N>;
  using Matrix = SmallMatrix<N>;

  SmallForces(const Model& model, double step);

  /// y += (Δt²/4) Q of (q, v) without its constant part, matrix += (Δt/2) C + (Δt²/4) K.
  [[gnu::always_inline]] void add(const double* q, const double* v, Matrix& matrix, Row& y) const {
    for (const Stretched& spring : springs_) add_spring(spring, q, v, matrix, y);
    for (const Turned& spring : torsions_) add_torsion(spring, q, v, matrix, y);
    for (const Driven& couple : couples_) add_couple(couple, q, y);
  }

 private:
  struct Stretched {
    Difference<N, D> d;
    double stiffness, damping, length, weight;  // weight: (Δt/2) c + (Δt²/4) k
  };
  struct Turned {
    Difference<N, D> u, w;
    double stiffness, damping, angle, weight;
    int axis;
  };
  struct Driven {
    Difference<N, D> w;
    double torque;
    int axis;
  };
  [[gnu::always_inline]] void add_spring(const Stretched& spring, const double* q, const double* v,
                                         Matrix& matrix, Row& y) const;
  [[gnu::always_inline]] void add_torsion(const Turned& spring, const double* q, const double* v,
                                          Matrix& matrix, Row& y) const;
  [[gnu::always_inline]] void add_couple(const Driven& couple, const double* q, Row& y) const;
  /// y = z × x; planar z is (0, 0, 1).
  static void turn(const double* z, const double* x, double* y);

  double h_;
  std::vector<Stretched> springs_;
  std::vector<Turned> torsions_;
  std::vector<Driven> couples_;
};

template <int N, int D>
void SmallForces<N, D>::turn(const double* z, const double* x, double* y) {
  if constexpr (D == 2) {
    y[0] = -x[1];
    y[1] = x[0];
  } else {
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3, k = (i + 2) % 3;
      y[i] = z[j] * x[k] - z[k] * x[j];
    }
  }
}

template <int N, int D>
inline void SmallForces<N, D>::add_spring(const Stretched& spring, const double* q, const double* v,
                                          Matrix& matrix, Row& y) const {
  double e[D], rate[D];
  spring.d.of(q, e);
  spring.d.of(v, rate);
  const double length = std::sqrt(dot<D>(e, e));
  const double inverse = length == 0.0 ? 0.0 : 1.0 / length;
  for (int x = 0; x < D; ++x) e[x] *= inverse;
  Row row = Row::zero();
  spring.d.add_transposed(e, row);
  y.add(-h_ * (spring.stiffness * (length - spring.length) + spring.damping * dot<D>(e, rate)),
        row);
  const double across = h_ * std::max(0.0, spring.stiffness * (1.0 - spring.length * inverse));
  Row columns[D];
  for (int x = 0; x < D; ++x) {
    columns[x] = Row::zero();
    columns[x].add((spring.weight - across) * e[x], row);
    columns[x].add(across, spring.d.rows[x]);
  }
  spring.d.add_outer(columns, matrix);
}

template <int N, int D>
inline void SmallForces<N, D>::add_torsion(const Turned& spring, const double* q, const double* v,
                                           Matrix& matrix, Row& y) const {
  double u[D], w[D], at_u[D], at_w[D], rate_u[D], rate_w[D];
  spring.u.of(q, u);
  spring.w.of(q, w);
  spring.u.of(v, rate_u);
  spring.w.of(v, rate_w);
  turn(q + spring.axis, u, at_u);
  turn(q + spring.axis, w, at_w);
  const double inverse_u = -1.0 / dot<D>(u, u), inverse_w = 1.0 / dot<D>(w, w);
  // z · (u × w) = (z × u) · w
  const double angle = std::atan2(dot<D>(at_u, w), dot<D>(u, w));
  const double turned = std::remainder(angle - spring.angle, 6.283185307179586476925286766559);
  for (int x = 0; x < D; ++x) at_u[x] *= inverse_u;
  for (int x = 0; x < D; ++x) at_w[x] *= inverse_w;
  const double rate = dot<D>(at_u, rate_u) + dot<D>(at_w, rate_w);
  Row row = Row::zero();
  spring.u.add_transposed(at_u, row);
  spring.w.add_transposed(at_w, row);
  y.add(-h_ * (spring.stiffness * turned + spring.damping * rate), row);
  Row scaled = Row::zero();
  scaled.add(spring.weight, row);
  spring.u.add_columns(scaled, at_u, matrix);
  spring.w.add_columns(scaled, at_w, matrix);
}

template <int N, int D>
inline void SmallForces<N, D>::add_couple(const Driven& couple, const double* q, Row& y) const {
  double w[D], turned[D];
  couple.w.of(q, w);
  turn(q + couple.axis, w, turned);
  const double force = h_ * couple.torque / dot<D>(w, w);
  for (int x = 0; x < D; ++x) turned[x] *= force;
  couple.w.add_transposed(turned, y);
}

template <int N, int D>
SmallForces<N, D>::SmallForces(const Model& model, double step) : h_(step * step / 4.0) {
  const auto weight = [&](double damping, double stiffness) {
    return step / 2.0 * damping + h_ * stiffness;
  };
  for (const Spring& s : model.springs()) {
    springs_.push_back(
        {{model, s.a, s.b}, s.stiffness, s.damping, s.length, weight(s.damping, s.stiffness)});
  }
  for (const TorsionSpring& s : model.torsion_springs()) {
    torsions_.push_back({{model, s.a, s.b},
                         {model, s.c, s.d},
                         s.stiffness,
                         s.damping,
                         s.angle,
                         weight(s.damping, s.stiffness),
                         Difference<N, D>::place(model, s.axis)});
  }
  for (const Couple& c : model.couples()) {
    couples_.push_back({{model, c.a, c.b}, c.torque, Difference<N, D>::place(model, c.axis)});
  }
}

}  // namespace mbs::compiled_ldl
