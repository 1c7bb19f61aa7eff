// Projections of velocities and accelerations of a chain, Eq. (6), with its last factors.
#pragma once

#include "newton.hpp"

namespace mbs::compiled_chains {

/// With `kMasked` λ of some lanes is up to date already: all but those `pending`.
template <class Store, bool kMasked = false>
class Projection {
 public:
  using V = typename Store::V;
  using Mask = typename Lanes<typename Store::Use>::Mask;

  /// λ of the last pass, Eq. (1), and v of (2), unprojected.
  static void settle(Store& chain, const Mask& pending = Mask()) {
    for (int k = 0; k <= chain.last; ++k) {
      B& block = chain.blocks[k];
      rods(block, *chain.constants[k], pending);
      if (k < chain.last) link(block, chain.blocks[k + 1], *chain.constants[k], pending);
      block.w = block.w + block.u;
    }
  }

  /// λ of the last pass and the projected v.
  static void velocity(Store& chain) {
    velocity_inwards(chain, Mask());
    velocity_outwards(chain);
  }
  static void velocity_inwards(Store& chain, const Mask& pending) {
    substitute_inwards(chain, Velocity<true>(chain, pending));
  }
  static void velocity_outwards(Store& chain) {
    substitute_outwards(chain, [](B& block, const Vec<V>& x) { block.w = x; });
  }

  /// The projected a, with that v.
  static void acceleration(Store& chain) {
    substitute_inwards(chain, Acceleration<false>(chain, Mask()));
    substitute_outwards(chain, [](B& block, const Vec<V>& x) { block.u = x; });
  }

  /// All of that, for two groups by turns. λ is left to the sweep that needs vectors anyway.
  static void both(Store& a, const Mask& pending_a, Store& b, const Mask& pending_b) {
    const auto set_velocity = [](B& block, const Vec<V>& x) { block.w = x; };
    const auto set_acceleration = [](B& block, const Vec<V>& x) { block.u = x; };
    substitute_inwards(a, Velocity<false>(a, pending_a), b, Velocity<false>(b, pending_b));
    substitute_outwards(a, set_velocity, b, set_velocity);
    substitute_inwards(a, Acceleration<true>(a, pending_a), b, Acceleration<true>(b, pending_b));
    substitute_outwards(a, set_acceleration, b, set_acceleration);
  }

 private:
  using B = typename Store::B;
  using C = typename Store::C;

  MBS_CHAIN_INLINE static void add(V& multiplier, const V& violation, const Mask& pending) {
    set<kMasked>(multiplier, V(multiplier + violation), pending);
  }
  MBS_CHAIN_INLINE static void rods(B& block, const C& data, const Mask& pending) {
    for (int j = 0; j < Store::kRods; ++j) {
      add(block.rods[j], data.rods[j].violation(data.rods[j].vector(block.x)), pending);
    }
  }
  MBS_CHAIN_INLINE static void link(B& block, const B& next, const C& data, const Mask& pending) {
    add(block.link, data.link.violation(data.link.vector(next.x - block.x)), pending);
  }

  // Below, what a block has in common with the one before has been read with that; with `kSettles`
  // λ of the last pass is completed.

  /// M v*
  template <bool kSettles>
  struct Velocity {
    Mask pending;
    Vec<V> x, v;  // of the block

    MBS_CHAIN_INLINE Velocity(const Store& chain, const Mask& pending)
        : pending(pending), x(chain.blocks[0].x), v(chain.blocks[0].w + chain.blocks[0].u) {}

    MBS_CHAIN_INLINE Vec<V> point(B& block, const C& data) {
      for (int j = 0; kSettles && j < Store::kRods; ++j) {
        add(block.rods[j], data.rods[j].violation(data.rods[j].vector(x)), pending);
      }
      return data.mass.times(v);
    }
    MBS_CHAIN_INLINE void link(B& block, const B& next, const C& data, Vec<V>& f, Vec<V>& inner) {
      if constexpr (kSettles) {
        const Vec<V> outer = x;
        x = read(next.x);
        add(block.link, data.link.violation(data.link.vector(x - outer)), pending);
      }
      inner = data.mass.inner(v);
      v = next.w + next.u;
      f = f + data.mass.outer(v);
    }
  };

  /// M a* − (Δt²/4) α Φqᵀ Φ̇q v'
  template <bool kSettles>
  struct Acceleration {
    Mask pending;
    Vec<V> x, w, u;  // of the block

    MBS_CHAIN_INLINE Acceleration(const Store& chain, const Mask& pending)
        : pending(pending), x(chain.blocks[0].x), w(chain.blocks[0].w), u(chain.blocks[0].u) {}

    MBS_CHAIN_INLINE Vec<V> point(B& block, const C& data) {
      Vec<V> f = data.mass.times(u);
      const V half_square = (V{} + 0.5) * dot(w, w);
      for (int j = 0; j < Store::kRods; ++j) {
        const Vec<V> d = data.rods[j].vector(x);
        if (kSettles) add(block.rods[j], data.rods[j].violation(d), pending);
        f = f - half_square * d;
      }
      return f;
    }
    MBS_CHAIN_INLINE void link(B& block, const B& next, const C& data, Vec<V>& f, Vec<V>& inner) {
      const Vec<V> x_inner = read(next.x), w_inner = read(next.w), u_inner = read(next.u);
      const Vec<V> e = data.link.vector(x_inner - x);
      if (kSettles) add(block.link, data.link.violation(e), pending);
      const Vec<V> rate = w_inner - w;
      const Vec<V> pull = ((V{} + 0.5) * dot(rate, rate)) * e;
      f = f + (data.mass.outer(u_inner) + pull);
      inner = data.mass.inner(u) - pull;
      x = x_inner;
      w = w_inner;
      u = u_inner;
    }
  };
};

}  // namespace mbs::compiled_chains
