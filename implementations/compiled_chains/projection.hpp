// Projections of velocities and accelerations of a chain, Eq. (6), with its last factors.
#pragma once

#include "newton.hpp"

namespace mbs::compiled_chains {

/// In place. λ of the last pass is completed, too, Eq. (1).
template <class Store>
class Projection {
 public:
  using V = typename Store::V;

  /// v of (2), unprojected.
  static void none(Store& chain) {
    for (int k = 0; k <= chain.last; ++k) {
      B& block = chain.blocks[k];
      settle_rods(block, *chain.constants[k], block.f);
      block.w = block.w + block.u;
      if (k == chain.last) break;
      settle_link(block, *chain.constants[k], chain.blocks[k + 1].f - block.f);
    }
  }
  static void velocity(Store& chain) {
    substitute_inwards<&B::w>(chain, Velocity<true>(chain));
    substitute_outwards<&B::w>(chain, set_velocity);
  }
  /// With that v.
  static void acceleration(Store& chain) {
    substitute_inwards<&B::u>(chain, Acceleration<false>(chain));
    substitute_outwards<&B::u>(chain, set_acceleration);
  }
  /// Both, for two groups by turns.
  static void both(Store& a, Store& b) {
    substitute_inwards<&B::w>(a, Velocity<false>(a), b, Velocity<false>(b));
    substitute_outwards<&B::w>(a, set_velocity, b, set_velocity);
    substitute_inwards<&B::u>(a, Acceleration<true>(a), b, Acceleration<true>(b));
    substitute_outwards<&B::u>(a, set_acceleration, b, set_acceleration);
  }

 private:
  using B = typename Store::B;
  using C = typename Store::C;

  static constexpr auto set_velocity = [](B& block, const Vec<V>& x) { block.w = x; };
  static constexpr auto set_acceleration = [](B& block, const Vec<V>& x) { block.u = x; };

  MBS_CHAIN_INLINE static void settle_rods(B& block, const C& data, const Vec<V>& x) {
    for (int j = 0; j < Store::kRods; ++j) {
      block.rods[j] += data.rods[j].violation(data.rods[j].vector(x));
    }
  }
  MBS_CHAIN_INLINE static void settle_link(B& block, const C& data, const Vec<V>& difference) {
    block.link += data.link.violation(data.link.vector(difference));
  }

  // Below, what a block has in common with the one before has been read with that.

  /// M v*; completes λ.
  template <bool kSettles>
  struct Velocity {
    Vec<V> x, v;  // of the block

    MBS_CHAIN_INLINE explicit Velocity(const Store& chain)
        : x(chain.blocks[0].f), v(chain.blocks[0].w + chain.blocks[0].u) {}

    MBS_CHAIN_INLINE Vec<V> point(B& block, const C& data) const {
      if constexpr (kSettles) settle_rods(block, data, x);
      return data.mass.times(v);
    }
    MBS_CHAIN_INLINE void link(B& block, const B& next, const C& data, Vec<V>& f, Vec<V>& inner) {
      if constexpr (kSettles) {
        const Vec<V> x_inner = read(next.f);
        settle_link(block, data, x_inner - x);
        x = x_inner;
      }
      inner = data.mass.inner(v);
      v = next.w + next.u;
      f = f + data.mass.outer(v);
    }
  };

  /// M a* − (Δt²/4) α Jᵀ Φ̇q v'
  template <bool kSettles>
  struct Acceleration {
    Vec<V> x, w, u;  // of the block

    MBS_CHAIN_INLINE explicit Acceleration(const Store& chain)
        : x(chain.blocks[0].x), w(chain.blocks[0].w), u(chain.blocks[0].u) {}

    MBS_CHAIN_INLINE Vec<V> point(B& block, const C& data) const {
      if constexpr (kSettles) settle_rods(block, data, block.f);
      Vec<V> f = data.mass.times(u);
      const V half_square = (V{} + 0.5) * dot(w, w);
      for (int j = 0; j < Store::kRods; ++j) f = f - half_square * data.rods[j].vector(x);
      return f;
    }
    MBS_CHAIN_INLINE void link(B& block, const B& next, const C& data, Vec<V>& f, Vec<V>& inner) {
      if constexpr (kSettles) settle_link(block, data, next.f - block.f);
      const Vec<V> x_inner = read(next.x), w_inner = read(next.w), u_inner = read(next.u);
      const Vec<V> rate = w_inner - w;
      const Vec<V> pull = ((V{} + 0.5) * dot(rate, rate)) * data.link.vector(x_inner - x);
      f = f + (data.mass.outer(u_inner) + pull);
      inner = data.mass.inner(u) - pull;
      x = x_inner;
      w = w_inner;
      u = u_inner;
    }
  };
};

}  // namespace mbs::compiled_chains
