// Projections of velocities and accelerations of a chain, Eq. (6), with its last factors.
#pragma once

#include "newton.hpp"

namespace mbs::compiled_chains {

/// v and a give way to right-hand sides, these to solutions: f has positions. λ of the last pass is
/// completed with the velocities, Eq. (1).
template <class Store>
class Projection {
 public:
  using V = typename Store::V;

  /// v of (2), unprojected.
  static void settle(Store& chain) {
    for (int k = 0; k <= chain.last; ++k) {
      B& block = chain.blocks[k];
      block.w = block.w + block.u;
      settle_rods(block, *chain.constants[k], block.f);
      if (k == chain.last) break;
      settle_link(block, *chain.constants[k], chain.blocks[k + 1].f - block.f);
    }
  }
  static void velocity(Store& chain) { solve<Velocity>(chain); }
  /// With that v.
  static void acceleration(Store& chain) { solve<Acceleration>(chain); }
  /// Both, of two groups by turns.
  static void both(Store& a, Store& b) {
    solve<Velocity>(a, b);
    solve<Acceleration>(a, b);
  }

 private:
  using B = typename Store::B;
  using C = typename Store::C;

  template <auto kSide>
  struct InPlace {
    MBS_CHAIN_INLINE void operator()(B& block, const Vec<V>& x) const { block.*kSide = x; }
  };
  template <class Terms>
  static void solve(Store& chain) {
    substitute_inwards<Store, Terms, Terms::kSide>(chain, Terms(chain));
    using Set = InPlace<Terms::kSide>;
    substitute_outwards<Store, Set, Terms::kSide>(chain, Set());
  }
  template <class Terms>
  static void solve(Store& a, Store& b) {
    substitute_inwards<Store, Terms, Terms::kSide>(a, Terms(a), b, Terms(b));
    using Set = InPlace<Terms::kSide>;
    substitute_outwards<Store, Set, Terms::kSide>(a, Set(), b, Set());
  }

  MBS_CHAIN_INLINE static void settle_rods(B& block, const C& data, const Vec<V>& x) {
    for (int j = 0; j < Store::kRods; ++j) {
      block.rods[j] += data.rods[j].violation(data.rods[j].vector(x));
    }
  }
  MBS_CHAIN_INLINE static void settle_link(B& block, const C& data, const Vec<V>& difference) {
    block.link += data.link.violation(data.link.vector(difference));
  }

  // Below, what a block has in common with the one before has been read with that.

  /// M v*
  struct Velocity {
    static constexpr auto kSide = &B::w;
    Vec<V> x, v;  // of the block: q', v*

    MBS_CHAIN_INLINE explicit Velocity(const Store& chain)
        : x(chain.blocks[0].f), v(chain.blocks[0].w + chain.blocks[0].u) {}

    MBS_CHAIN_INLINE Vec<V> point(B& block, const C& data) const {
      settle_rods(block, data, x);
      return data.mass.times(v);
    }
    MBS_CHAIN_INLINE void link(B& block, const B& next, const C& data, Vec<V>& f, Vec<V>& inner) {
      const Vec<V> x_inner = read(next.f);
      settle_link(block, data, x_inner - x);
      x = x_inner;
      inner = data.mass.inner(v);
      v = next.w + next.u;
      f = f + data.mass.outer(v);
    }
  };

  /// M a* − (Δt²/4) α Jᵀ Φ̇q v', J of the last pass
  struct Acceleration {
    static constexpr auto kSide = &B::u;
    Vec<V> x, w, u;  // of the block: q' of the last pass, v', a*

    MBS_CHAIN_INLINE explicit Acceleration(const Store& chain)
        : x(chain.blocks[0].x), w(chain.blocks[0].w), u(chain.blocks[0].u) {}

    MBS_CHAIN_INLINE Vec<V> point(const B&, const C& data) const {
      Vec<V> f = data.mass.times(u);
      const V half_square = (V{} + 0.5) * dot(w, w);
      for (int j = 0; j < Store::kRods; ++j) f = f - half_square * data.rods[j].vector(x);
      return f;
    }
    MBS_CHAIN_INLINE void link(const B&, const B& next, const C& data, Vec<V>& f, Vec<V>& inner) {
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
