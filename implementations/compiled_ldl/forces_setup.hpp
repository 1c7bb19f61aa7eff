// Forces<S, D>: tables made from the models, C and K. Part of forces.hpp.
#pragma once

#include "forces.hpp"

namespace mbs::compiled_ldl {

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
  keep();
}

template <typename S, int D>
void Forces<S, D>::keep() {
  kept_ = direction_;
  kept_across_ = across_;
  kept_torsions_ = torsion_directions_;
}

template <typename S, int D>
template <typename F>
void Forces<S, D>::add_matrix(F* matrix) const {
  for (int k = 0; k < springs_.one; ++k) {
    const S across = h_ * kept_across_[k];
    add_pair<D>(matrix, springs_.list[k], springs_.free(k), weight_[k] - across,
                kept_.data() + k * D);
    add_pair_identity<D>(matrix, springs_.list[k], springs_.free(k), across);
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

}  // namespace mbs::compiled_ldl
