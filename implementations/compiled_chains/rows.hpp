// Blocks that keep the rows of Φq of their factors, and what is evaluated with these.
#pragma once

#include "elimination.hpp"

namespace mbs::compiled_chains {

/// The same P with Q at (5, −2): d[0] = P − A = (0, −ℓ), e = Q − P = (0, −ℓ).
template <class V, class Rods>
struct RowBlock : Block<V, Rods> {
  Vec<V> d[Rods::kMost];  // of its rods, from the fixed point
  Vec<V> e;               // of its link, to the next point inwards
};

/// ε⁻¹ (Φq a + Φ̇q v) of a distance.
template <class B>
MBS_CHAIN_INLINE auto rod_rate(const B& block, int j) {
  return dot(block.d[j], block.u) + 0.5 * dot(block.w, block.w);
}
template <class B>
MBS_CHAIN_INLINE auto link_rate(const B& block, const B& next) {
  const auto rate = next.w - block.w;
  return dot(block.e, next.u - block.u) + 0.5 * dot(rate, rate);
}

/// A force along a link on its two points: `f` of the outer one gains it, `inner` is the other's.
template <class V>
MBS_CHAIN_INLINE void pull_together(const V& force, const Vec<V>& e, Vec<V>& f, Vec<V>& inner) {
  f = f + force * e;
  inner = Vec<V>{} - force * e;
}

/// −ε⁻¹ Φqᵀ Φ with the Φq of the factors and the Φ of where the points are.
template <class Store>
struct PositionResidual {
  using V = typename Store::V;
  using B = typename Store::B;
  using C = typename Store::C;

  MBS_CHAIN_INLINE Vec<V> point(const B& block, const C& data) const {
    Vec<V> f{};
    for (int j = 0; j < Store::kRods; ++j) {
      f = f + data.rods[j].violation(data.rods[j].vector(block.x)) * block.d[j];
    }
    return f;
  }
  MBS_CHAIN_INLINE void link(const B& block, const B& next, const C& data, Vec<V>& f,
                             Vec<V>& inner) const {
    const V violation = data.link.violation(data.link.vector(next.x - block.x));
    f = f - violation * block.e;
    inner = violation * block.e;
  }
};

/// −ε⁻¹ Φqᵀ Φq v, where `velocity(block)` is v.
template <class Store, class Velocity>
struct VelocityResidual {
  using V = typename Store::V;
  using B = typename Store::B;
  using C = typename Store::C;
  Velocity velocity;

  MBS_CHAIN_INLINE Vec<V> point(const B& block, const C&) const {
    Vec<V> f{};
    const Vec<V> v = velocity(block);
    for (int j = 0; j < Store::kRods; ++j) f = f - dot(block.d[j], v) * block.d[j];
    return f;
  }
  MBS_CHAIN_INLINE void link(const B& block, const B& next, const C&, Vec<V>& f,
                             Vec<V>& inner) const {
    pull_together(dot(block.e, velocity(next) - velocity(block)), block.e, f, inner);
  }
};

/// −ε⁻¹ Φqᵀ (Φq a + Φ̇q v). `multiplier(number, rate)` is told each ε⁻¹ (Φq a + Φ̇q v).
template <class Store, class Multiplier>
struct AccelerationResidual {
  using V = typename Store::V;
  using B = typename Store::B;
  using C = typename Store::C;
  Multiplier multiplier;

  MBS_CHAIN_INLINE Vec<V> point(B& block, const C&) const {
    Vec<V> f{};
    for (int j = 0; j < Store::kRods; ++j) {
      const V rate = rod_rate(block, j);
      multiplier(block.rods[j], rate);
      f = f - rate * block.d[j];
    }
    return f;
  }
  MBS_CHAIN_INLINE void link(B& block, const B& next, const C&, Vec<V>& f, Vec<V>& inner) const {
    const V rate = link_rate(block, next);
    multiplier(block.link, rate);
    pull_together(rate, block.e, f, inner);
  }
};

template <class Store, class Velocity>
MBS_CHAIN_INLINE void velocity_residual(Store& chain, const Velocity& velocity) {
  substitute_inwards(chain, VelocityResidual<Store, Velocity>{velocity});
}
template <class Store, class Multiplier>
MBS_CHAIN_INLINE void acceleration_residual(Store& chain, const Multiplier& multiplier) {
  substitute_inwards(chain, AccelerationResidual<Store, Multiplier>{multiplier});
}

}  // namespace mbs::compiled_chains
