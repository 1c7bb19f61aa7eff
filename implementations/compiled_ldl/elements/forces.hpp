// Applied forces, Eq. (11): springs, torsion springs, couples; what they add to C and K.
#pragma once

#include "scene.hpp"

namespace mbs::compiled_ldl {

/// Two springs and a torsion spring in the plane: direction_ = {e_x e_y} of each spring,
/// torsion_directions_ = {A_x A_y C_x C_y}, across_ = p of each spring.
template <typename S, int D>
class Forces {
 public:
  Forces(std::span<const Model* const> models, const Program& program, const Rows& rows,
         double step);

  [[nodiscard]] bool any() const { return has_stiffness() || !couples_.empty(); }
  [[nodiscard]] bool has_stiffness() const { return springs_.count() > 0 || !torsions_.empty(); }

  /// y += factor times Q of (q, v), without its constant part.
  void add(const S* q, const S* v, const S& factor, S* y);
  /// Keeps C and K of the last add() for what follows, until the next add().
  void keep();
  void keep_where(const LaneMask& mask) {
    copy_where(mask, direction_, kept_);
    copy_where(mask, across_, kept_across_);
    copy_where(mask, torsion_directions_, kept_torsions_);
  }
  /// += (Δt/2) C + (Δt²/4) K.
  template <typename F>
  void add_matrix(F* matrix) const;
  /// y += ((Δt/2) C + (Δt²/4) K) x.
  void add_product(const S* x, S* y) const;

 private:
  struct Element {
    S stiffness, damping, free;  // free length or angle
  };
  struct Couple2 {
    int a, b, axis;
    S torque;
  };
  void add_spring(const S* q, const S* v, const S& factor, S* y, int k);
  void add_torsion(const S* q, const S* v, const S& factor, S* y, int k);
  void add_couple(const S* q, const S& factor, S* y, const Couple2& couple) const;
  /// y = z × x; planar z is (0, 0, 1).
  static void turn(const S* z, const S* x, S* y);

  Pairs springs_;
  std::vector<Quad> torsions_;
  std::vector<int> torsion_axes_;  // rows
  std::vector<Place> places_;
  std::vector<Couple2> couples_;
  Array<Element> spring_, torsion_;
  Array<S> direction_,
      torsion_directions_;  // gradients: e of a spring, A and C of a torsion spring
  Array<S> across_;         // p of a spring
  Array<S> kept_, kept_torsions_, kept_across_;
  Array<S> weight_, torsion_weight_;  // (Δt/2) c + (Δt²/4) k
  S h_;                               // Δt²/4
};

// Tables made from the models; C and K.

template <typename S, int D>
Forces<S, D>::Forces(std::span<const Model* const> models, const Program& program, const Rows& rows,
                     double step)
    : h_(static_cast<S>(step * step / 4.0)) {
  const Model& first = *models[0];
  std::vector<std::array<int, 2>> points;
  for (const Spring& spring : first.springs()) points.push_back({spring.a, spring.b});
  std::vector<int> order;
  springs_ = make_pairs(points, rows, order);
  place_pairs(springs_, program);
  const auto weight = [&](const Element& e) {
    return static_cast<S>(step / 2.0) * e.damping + h_ * e.stiffness;
  };
  for (const int k : order) {
    const auto get = [&](double Spring::*member) {
      return of_models<S>(models, [&](const Model& m) { return m.springs()[k].*member; });
    };
    spring_.push_back({get(&Spring::stiffness), get(&Spring::damping), get(&Spring::length)});
    weight_.push_back(weight(spring_.back()));
  }
  for (int k = 0; k < static_cast<int>(first.torsion_springs().size()); ++k) {
    const TorsionSpring& spring = first.torsion_springs()[k];
    torsions_.push_back(
        make_quad({spring.a, spring.b, spring.c, spring.d}, rows, program, &places_));
    torsion_axes_.push_back(spring.axis < 0 ? 0 : rows.of_point[spring.axis]);
    const auto get = [&](double TorsionSpring::*member) {
      return of_models<S>(models, [&](const Model& m) { return m.torsion_springs()[k].*member; });
    };
    torsion_.push_back(
        {get(&TorsionSpring::stiffness), get(&TorsionSpring::damping), get(&TorsionSpring::angle)});
    torsion_weight_.push_back(weight(torsion_.back()));
  }
  for (int k = 0; k < static_cast<int>(first.couples().size()); ++k) {
    const Couple& couple = first.couples()[k];
    couples_.push_back(
        {rows.of_point[couple.a], rows.of_point[couple.b],
         couple.axis < 0 ? 0 : rows.of_point[couple.axis],
         of_models<S>(models, [&](const Model& m) { return m.couples()[k].torque; })});
  }
  direction_.resize(spring_.size() * D, S(0.0));
  torsion_directions_.resize(torsion_.size() * 2 * D, S(0.0));
  across_.resize(spring_.size(), S(0.0));
  kept_ = direction_;
  kept_across_ = across_;
  kept_torsions_ = torsion_directions_;
}

template <typename S, int D>
void Forces<S, D>::keep() {
  kept_.swap(direction_);
  kept_across_.swap(across_);
  kept_torsions_.swap(torsion_directions_);
}

template <typename S, int D>
template <typename F>
void Forces<S, D>::add_matrix(F* matrix) const {
  for (int k = 0; k < springs_.one; ++k) {
    const S across = h_ * kept_across_[k];
    add_pair<D>(matrix, springs_.list[k], springs_.free(k), weight_[k] - across,
                kept_.data() + k * D, across);
  }
  for (std::size_t k = 0; k < torsions_.size(); ++k) {
    const S* vectors = kept_torsions_.data() + k * 2 * D;
    S g[4 * D];
    find_gradients<D>(torsions_[k], vectors, vectors + D, g);
    add_quad<D>(matrix, torsions_[k], places_.data(), torsion_weight_[k], g);
  }
}

template <typename S, int D>
void Forces<S, D>::add_product(const S* x, S* y) const {
  for (int k = 0; k < springs_.count(); ++k) {
    const Pair& pair = springs_.list[k];
    const S* e = kept_.data() + k * D;
    S d[D];
    for (int i = 0; i < D; ++i) d[i] = x[pair.a + i] - x[pair.b + i];
    const S across = h_ * kept_across_[k];
    const S along = (weight_[k] - across) * dot<D>(e, d);
    for (int i = 0; i < D; ++i) {
      const S t = along * e[i] + across * d[i];
      y[pair.a + i] += t;
      y[pair.b + i] -= t;
    }
  }
  for (std::size_t k = 0; k < torsions_.size(); ++k) {
    const Quad& quad = torsions_[k];
    const S* vectors = kept_torsions_.data() + k * 2 * D;
    S sum = S(0.0);
    for (int i = 0; i < D; ++i) {
      sum += vectors[i] * (x[quad.a + i] - x[quad.b + i]) +
             vectors[D + i] * (x[quad.c + i] - x[quad.d + i]);
    }
    sum *= torsion_weight_[k];
    for (int i = 0; i < D; ++i) {
      const S at_a = sum * vectors[i], at_c = sum * vectors[D + i];
      y[quad.a + i] += at_a;
      y[quad.b + i] -= at_a;
      y[quad.c + i] += at_c;
      y[quad.d + i] -= at_c;
    }
  }
}

// The forces themselves.

template <typename S, int D>
void Forces<S, D>::turn(const S* z, const S* x, S* y) {
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

template <typename S, int D>
void Forces<S, D>::add(const S* q, const S* v, const S& factor, S* y) {
  for (int k = 0; k < springs_.count(); ++k) add_spring(q, v, factor, y, k);
  for (int k = 0; k < static_cast<int>(torsions_.size()); ++k) add_torsion(q, v, factor, y, k);
  for (const Couple2& couple : couples_) add_couple(q, factor, y, couple);
}

/// All is read before anything is written, which the compiler need not prove then.
template <typename S, int D>
inline void Forces<S, D>::add_spring(const S* q, const S* v, const S& factor, S* y, int k) {
  const Pair& pair = springs_.list[k];
  const Element& spring = spring_[k];
  S e[D], rate[D], at_a[D], at_b[D];
  for (int i = 0; i < D; ++i) e[i] = q[pair.a + i] - q[pair.b + i];
  for (int i = 0; i < D; ++i) rate[i] = v[pair.a + i] - v[pair.b + i];
  const S length = each(dot<D>(e, e), [](auto x) { return std::sqrt(x); });
  const S inverse = each(length, [](auto x) { return x == 0 ? x : 1 / x; });
  for (int i = 0; i < D; ++i) e[i] *= inverse;
  const S force =
      factor * (spring.stiffness * (length - spring.free) + spring.damping * dot<D>(e, rate));
  for (int i = 0; i < D; ++i) at_a[i] = y[pair.a + i] - force * e[i];
  for (int i = 0; i < D; ++i) at_b[i] = y[pair.b + i] + force * e[i];
  const S across = larger(S(0.0), spring.stiffness * (S(1.0) - spring.free * inverse));
  for (int i = 0; i < D; ++i) y[pair.a + i] = at_a[i];
  for (int i = 0; i < D; ++i) y[pair.b + i] = at_b[i];
  for (int i = 0; i < D; ++i) direction_[k * D + i] = e[i];
  across_[k] = across;
}

template <typename S, int D>
void Forces<S, D>::add_torsion(const S* q, const S* v, const S& factor, S* y, int k) {
  const Quad& quad = torsions_[k];
  const Element& spring = torsion_[k];
  const S* z = q + torsion_axes_[k];
  S* at_a = torsion_directions_.data() + k * 2 * D;
  S* at_c = at_a + D;
  S u[D], w[D];
  for (int i = 0; i < D; ++i) u[i] = q[quad.a + i] - q[quad.b + i];
  for (int i = 0; i < D; ++i) w[i] = q[quad.c + i] - q[quad.d + i];
  turn(z, u, at_a);
  turn(z, w, at_c);
  // z · (u × w) = (z × u) · w
  const S angle =
      each(dot<D>(at_a, w), dot<D>(u, w), [](auto s, auto c) { return std::atan2(s, c); });
  const S turned = each(angle - spring.free, [](auto x) {
    using Number = decltype(x);
    if (std::fabs(x) <= Number(3.14)) return x;  // remainder() takes long to find that
    return std::remainder(x, static_cast<Number>(6.283185307179586476925286766559L));
  });
  const S inverse_u = S(1.0) / dot<D>(u, u), inverse_w = S(1.0) / dot<D>(w, w);
  S rate = S(0.0);
  for (int i = 0; i < D; ++i) {
    at_a[i] *= -inverse_u;
    at_c[i] *= inverse_w;
    rate += at_a[i] * (v[quad.a + i] - v[quad.b + i]) + at_c[i] * (v[quad.c + i] - v[quad.d + i]);
  }
  const S torque = factor * (spring.stiffness * turned + spring.damping * rate);
  for (int i = 0; i < D; ++i) {
    y[quad.a + i] -= torque * at_a[i];
    y[quad.b + i] += torque * at_a[i];
    y[quad.c + i] -= torque * at_c[i];
    y[quad.d + i] += torque * at_c[i];
  }
}

template <typename S, int D>
void Forces<S, D>::add_couple(const S* q, const S& factor, S* y, const Couple2& couple) const {
  S w[D], turned[D];
  for (int i = 0; i < D; ++i) w[i] = q[couple.a + i] - q[couple.b + i];
  turn(q + couple.axis, w, turned);
  const S force = factor * couple.torque / dot<D>(w, w);
  for (int i = 0; i < D; ++i) {
    y[couple.a + i] += force * turned[i];
    y[couple.b + i] -= force * turned[i];
  }
}

}  // namespace mbs::compiled_ldl
