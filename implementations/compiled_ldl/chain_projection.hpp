// Projections of velocities and accelerations of a chain, Eq. (6), with its last factors.
#pragma once

#include "chain_newton.hpp"

namespace mbs::compiled_ldl::chain {

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
    substitute_inwards(chain, Velocity{pending, chain.blocks[0].w + chain.blocks[0].u});
  }
  static void velocity_outwards(Store& chain) {
    substitute_outwards(chain, [](B& block, const Vec<V>& x) { block.w = x; });
  }
  static void velocity_outwards(Store& a, Store& b) {
    const auto set_velocity = [](B& block, const Vec<V>& x) { block.w = x; };
    substitute_outwards(a, set_velocity, b, set_velocity);
  }

  /// The projected a, with that v.
  static void acceleration(Store& chain) {
    acceleration_inwards(chain);
    acceleration_outwards(chain);
  }
  static void acceleration_inwards(Store& chain) { substitute_inwards(chain, Acceleration{}); }
  static void acceleration_outwards(Store& chain) {
    substitute_outwards(chain, [](B& block, const Vec<V>& x) { block.u = x; });
  }
  static void acceleration_outwards(Store& a, Store& b) {
    const auto set_acceleration = [](B& block, const Vec<V>& x) { block.u = x; };
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
    add(block.link, data.link.violation(data.link.vector(next.x - block.x, block.offset)), pending);
  }

  /// M v*
  struct Velocity {
    const Mask& pending;
    mutable Vec<V> v{};  // of the block, from the one before

    MBS_CHAIN_INLINE Vec<V> point(B& block, const C& data) const {
      rods(block, data, pending);
      return data.mass.times(v);
    }
    MBS_CHAIN_INLINE void link(B& block, const B& next, const C& data, Vec<V>& f,
                               Vec<V>& inner) const {
      Projection::link(block, next, data, pending);
      inner = data.mass.inner(v);
      v = next.w + next.u;
      f = f + data.mass.outer(v);
    }
  };

  /// M a* − (Δt²/4) α Φqᵀ Φ̇q v'
  struct Acceleration {
    MBS_CHAIN_INLINE Vec<V> point(const B& block, const C& data) const {
      Vec<V> f = data.mass.times(block.u);
      const V half_square = (V{} + 0.5) * dot(block.w, block.w);
      for (int j = 0; j < Store::kRods; ++j) f = f - half_square * data.rods[j].vector(block.x);
      return f;
    }
    MBS_CHAIN_INLINE void link(const B& block, const B& next, const C& data, Vec<V>& f,
                               Vec<V>& inner) const {
      const Vec<V> e = data.link.vector(next.x - block.x, block.offset);
      const Vec<V> rate = next.w - block.w;
      const Vec<V> pull = ((V{} + 0.5) * dot(rate, rate)) * e;
      f = f + (data.mass.outer(next.u) + pull);
      inner = data.mass.inner(block.u) - pull;
    }
  };
};

}  // namespace mbs::compiled_ldl::chain
