// Newton's passes of the penalty form over a chain, Eqs. (1) to (5): a sweep inwards, one outwards.
#pragma once

#include "chain_elimination.hpp"

namespace mbs::compiled_ldl::chain {

/// What decides about a pass.
template <class V>
struct PassResult {
  V least;    // pivot: the factorization is one if this is above 0
  V largest;  // |2 s Δq|
};

/// Lanes of which only some take part. All bits of a lane are set or none.
template <class Mask>
struct Taking {
  Mask pending;  // whose pass before has not yet given its λ
  Mask active;   // that this pass is for
};

template <class V, class Mask>
MBS_CHAIN_INLINE void keep(V& to, const V& value, const Mask& lanes) {
  to = lanes ? value : to;
}
template <class V, class Mask>
MBS_CHAIN_INLINE void keep(Vec<V>& to, const Vec<V>& value, const Mask& lanes) {
  keep(to.x, value.x, lanes);
  keep(to.y, value.y, lanes);
}
template <class V, class Mask>
MBS_CHAIN_INLINE void keep(Sym<V>& to, const Sym<V>& value, const Mask& lanes) {
  keep(to.xx, value.xx, lanes);
  keep(to.xy, value.xy, lanes);
  keep(to.yy, value.yy, lanes);
}
template <class V, class Mask>
MBS_CHAIN_INLINE void keep(Factors<V>& to, const Factors<V>& value, const Mask& lanes) {
  keep(to.scaled, value.scaled, lanes);
  for (int k = 0; k < 4; ++k) keep(to.gain[k], value.gain[k], lanes);
}

/// The first pass of a step predicts (step 1); later ones update λ, Eq. (1), by the Φ they begin
/// with. With `kMasked` only some lanes do anything.
template <class Store, bool kFirst, bool kMasked = false>
class Newton {
 public:
  using V = typename Store::V;
  using Mask = typename Lanes<typename Store::Use>::Mask;

  static PassResult<V> pass(Store& chain) {
    PassResult<V> result;
    result.least = inwards(chain, Taking<Mask>());
    result.largest = outwards(chain, Mask());
    return result;
  }

  /// The two sweeps of a pass; the least pivot, and max|2 s Δq|.
  static V inwards(Store& chain, const Taking<Mask>& taking) {
    B* block = chain.blocks.data();
    const C* data = chain.constants.data();
    B* const end = block + chain.last;
    Carry<V> carry;
    V least = V{} + 1.0;
    if (kFirst) predict(*block);
    for (; block != end; ++block, ++data) {
      if (kFirst) predict(block[1]);
      assemble_and_eliminate(*block, block[1], *data, taking, least, carry);
    }
    Vec<V> f = Vec<V>{} - data->force;
    const Sym<V> own = point(*block, *data, f, taking.pending);
    set(block->factors.scaled, meet<typename Store::Use>(own, carry, f, least, block->c),
        taking.active);
    return least;
  }
  static V outwards(Store& chain, const Mask& active) {
    LargestOf<typename Store::Use> largest;
    substitute_outwards(chain, [&](B& block, const Vec<V>& x) {  // Eqs. (4), (2)
      largest.add(x);
      set(block.x, block.x - (V{} + 0.5) * x, active);
      set(block.u, block.u - x, active);
    });
    return largest.value();
  }

 private:
  using B = typename Store::B;
  using C = typename Store::C;

  MBS_CHAIN_INLINE static void predict(B& block) {
    block.w = block.w + block.u;  // (2) makes the next w of this and the next u
    block.x = block.x + block.w;
  }

  template <class T>
  MBS_CHAIN_INLINE static void set(T& to, const T& value, const Mask& lanes) {
    if constexpr (kMasked) {
      keep(to, value, lanes);
    } else {
      to = value;
    }
  }

  /// The tension λ + p of a distance, (3), and λ of the pass before, Eq. (1).
  MBS_CHAIN_INLINE static V tension(V& multiplier, const V& violation, const Mask& pending) {
    if (!kFirst) set(multiplier, V(multiplier + violation), pending);
    return multiplier + violation;
  }

  /// M + Σ d dᵀ of a point, and its right-hand side but for links.
  MBS_CHAIN_INLINE static Sym<V> point(B& block, const C& data, Vec<V>& f, const Mask& pending) {
    f = f + data.mass.times(block.u);
    Sym<V> A;
    for (int j = 0; j < Store::kRods; ++j) {
      const Vec<V> d = data.rods[j].vector(block.x);
      f = f + tension(block.rods[j], data.rods[j].violation(d), pending) * d;
      A = j == 0 ? data.mass.plus_square(d) : plus_square(A, d);
    }
    return A;
  }

  MBS_CHAIN_INLINE static void assemble_and_eliminate(B& block, const B& next, const C& data,
                                                      const Taking<Mask>& taking, V& least,
                                                      Carry<V>& carry) {
    Vec<V> f = data.mass.outer(next.u) - data.force;
    const Sym<V> own = point(block, data, f, taking.pending);
    const Vec<V> e = data.link.vector(next.x - block.x);
    const Vec<V> pull = tension(block.link, data.link.violation(e), taking.pending) * e;
    f = carry.force + (f - pull);  // what waits for the block before comes last
    Sym<V> S;
    Vec<V> z;
    eliminate(data.mass, own, e, S, z, least, carry);
    Factors<V> factors;
    finish(factors, data.mass, S, z, carry.reciprocal, e);
    block.c = adjugate_times(factors.scaled, f);
    carry.force = forward(factors.gain, pull + data.mass.inner(block.u), f);
    set(block.factors, factors, taking.active);
  }
};

}  // namespace mbs::compiled_ldl::chain
