// Projections of velocities and accelerations of a chain, Eq. (6), with its last factors.
#pragma once

#include "newton.hpp"

namespace mbs::compiled_chains {

/// Solved for what v* and a* have too much. The d and e are those of the last pass, like T; λ of
/// that pass is completed with the velocities, Eq. (1).
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

  template <class Terms>
  static void solve(Store& chain) {
    substitute_inwards<Store, Terms, Terms::kSide>(chain, Terms(chain));
    using Apply = typename Terms::TakeAway;
    substitute_outwards<Store, Apply, Terms::kSide>(chain, Apply(chain));
  }
  template <class Terms>
  static void solve(Store& a, Store& b) {
    substitute_inwards<Store, Terms, Terms::kSide>(a, Terms(a), b, Terms(b));
    using Apply = typename Terms::TakeAway;
    substitute_outwards<Store, Apply, Terms::kSide>(a, Apply(a), b, Apply(b));
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

  /// (Δt²/4) α Jᵀ J v*
  struct Velocity {
    static constexpr auto kSide = &B::side;
    Vec<V> x, v;  // of the block: q' of the last pass, v*

    MBS_CHAIN_INLINE explicit Velocity(const Store& chain)
        : x(chain.blocks[0].x), v(chain.blocks[0].w + chain.blocks[0].u) {}

    MBS_CHAIN_INLINE Vec<V> point(const B&, const C& data) const {
      Vec<V> f{};
      for (int j = 0; j < Store::kRods; ++j) {
        const Vec<V> d = data.rods[j].vector(x);
        f = f + dot(d, v) * d;
      }
      return f;
    }
    MBS_CHAIN_INLINE void link(const B&, const B& next, const C& data, Vec<V>& f, Vec<V>& inner) {
      const Vec<V> x_inner = read(next.x), v_inner = next.w + next.u;
      const Vec<V> e = data.link.vector(x_inner - x);
      inner = product(dot(e, v_inner - v), e);
      f = f - inner;
      x = x_inner;
      v = v_inner;
    }
    /// Completes λ as well: outwards there is less to do.
    struct TakeAway {
      const C* const* data;
      Vec<V> inner;  // q' of the block inwards; the last block has no link, so there it is any

      explicit TakeAway(const Store& chain) : data(chain.constants.data() + chain.last) {}
      MBS_CHAIN_INLINE void operator()(B& block, const Vec<V>& x) {
        block.w = (block.w + block.u) - x;
        const Vec<V> q = read(block.f);
        settle_rods(block, **data, q);
        settle_link(block, **data, inner - q);
        inner = q;
        --data;
      }
    };
  };

  /// (Δt²/4) α Jᵀ (J a* + Φ̇q v')
  struct Acceleration {
    static constexpr auto kSide = &B::x;
    Vec<V> x, w, u;  // of the block: q' of the last pass, v', a*

    MBS_CHAIN_INLINE explicit Acceleration(const Store& chain)
        : x(chain.blocks[0].x), w(chain.blocks[0].w), u(chain.blocks[0].u) {}

    MBS_CHAIN_INLINE Vec<V> point(const B&, const C& data) const {
      Vec<V> f{};
      const V half_square = (V{} + 0.5) * dot(w, w);
      for (int j = 0; j < Store::kRods; ++j) {
        const Vec<V> d = data.rods[j].vector(x);
        f = f + (dot(d, u) + half_square) * d;
      }
      return f;
    }
    MBS_CHAIN_INLINE void link(const B&, const B& next, const C& data, Vec<V>& f, Vec<V>& inner) {
      const Vec<V> x_inner = read(next.x), w_inner = read(next.w), u_inner = read(next.u);
      const Vec<V> rate = w_inner - w;
      const Vec<V> e = data.link.vector(x_inner - x);
      inner = product(dot(e, u_inner - u) + (V{} + 0.5) * dot(rate, rate), e);
      f = f - inner;
      x = x_inner;
      w = w_inner;
      u = u_inner;
    }
    struct TakeAway {
      explicit TakeAway(const Store&) {}
      MBS_CHAIN_INLINE void operator()(B& block, const Vec<V>& x) const { block.u = block.u - x; }
    };
  };
};

}  // namespace mbs::compiled_chains
