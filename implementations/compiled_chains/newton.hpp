// Newton's passes of the penalty form over a chain, Eqs. (1) to (5): a sweep inwards, one outwards.
#pragma once

#include "elimination.hpp"

namespace mbs::compiled_chains {

/// x is where the last pass evaluated the point, so that projections find its Φq; f is where it is
/// since, until the next pass has taken it from there.
template <class V, class Rods>
struct PassBlock : Block<V, Rods> {
  Vec<V> side;  // what is between two sweeps and has no place in f

  static constexpr auto kPosition = &PassBlock::f;
};

/// What decides about a pass.
template <class V>
struct PassResult {
  V least;    // pivot: the factorization is one if this is above 0
  V largest;  // |2 s Δq|
};

/// The first pass of a step predicts (step 1); later ones update λ, Eq. (1), by the Φ they begin
/// with. With `kMasked` only the lanes `active` do anything: all bits of a lane are set or none.
template <class Store, bool kFirst, bool kMasked = false>
class Newton {
 public:
  using V = typename Store::V;
  using Mask = typename Lanes<typename Store::Use>::Mask;

  static PassResult<V> pass(Store& chain) {
    PassResult<V> result;
    result.least = inwards(chain, Mask());
    result.largest = outwards(chain, Mask());
    return result;
  }

  /// The two sweeps of a pass; the least pivot, and max|2 s Δq|.
  static V inwards(Store& chain, const Mask& active) {
    B* block = chain.blocks.data();
    const C* const* data = chain.constants.data();
    B* const end = block + chain.last;
    Carry<V> carry;
    V least = V{} + 1.0;
    begin(*block, active);
    if (block != end) {
      Pending before;
      begin(block[1], active);
      eliminate_block(*block, block[1], **data, active, least, carry, before);
      for (++block, ++data; block != end; ++block, ++data) {
        begin(block[1], active);
        Pending now;
        eliminate_block(*block, block[1], **data, active, least, carry, now);
        finish_block(block[-1], *data[-1], before, active, carry);
        before = now;
      }
      finish_block(block[-1], *data[-1], before, active, carry);
    }
    finish_chain(*block, **data, active, least, carry);
    return least;
  }
  /// Of two groups by turns: between a block's division and its factors comes the other's block.
  static void inwards(Store& a, const Mask& active_a, V& least_a, Store& b, const Mask& active_b,
                      V& least_b) {
    InwardsSweep sweep_a(a, active_a), sweep_b(b, active_b);  // elsewhere they would be in memory
    for (int k = 0; k < a.last; ++k) {
      sweep_a.eliminate();
      if (k > 0) sweep_b.complete();
      sweep_b.eliminate();
      sweep_a.complete();
    }
    if (a.last > 0) sweep_b.complete();
    sweep_a.finish();
    sweep_b.finish();
    least_a = sweep_a.least;
    least_b = sweep_b.least;
  }
  static V outwards(Store& chain, const Mask& active) {
    LargestOf<typename Store::Use> largest;
    substitute_outwards<Store, Move, &B::f, Solved>(chain, Move{largest, active});
    return largest.value();
  }
  static void outwards(Store& a, const Mask& active_a, V& largest_a, Store& b, const Mask& active_b,
                       V& largest_b) {
    LargestOf<typename Store::Use> of_a, of_b;
    substitute_outwards<Store, Move, &B::f, Solved>(a, Move{of_a, active_a}, b,
                                                    Move{of_b, active_b});
    largest_a = of_a.value();
    largest_b = of_b.value();
  }

 private:
  using B = typename Store::B;
  using C = typename Store::C;

  /// Takes a point to where the pass evaluates it.
  MBS_CHAIN_INLINE static void begin(B& block, const Mask& active) {
    if (kFirst) {
      block.w = block.w + block.u;  // (2) makes the next w of this and the next u
      block.x = block.f + block.w;
    } else {
      set<kMasked>(block.x, block.f, active);
    }
  }

  /// The tension λ + p of a distance, (3), and λ of the pass before, Eq. (1).
  MBS_CHAIN_INLINE static V tension(V& multiplier, const V& violation, const Mask& active) {
    if (!kFirst) set<kMasked>(multiplier, V(multiplier + violation), active);
    return multiplier + violation;
  }

  /// c = S⁻¹ (f − t e) for the sweep outwards. In S⁻¹ (t e) most digits would cancel: y = S⁻¹ e
  /// has them. In a single chain that sweep has time to spare, and S⁻¹ f is left to it.
  MBS_CHAIN_INLINE static void keep_solution(B& block, const Sym<V>& scaled, const Vec<V>& f,
                                             const Vec<V>& pull_solved, const Mask& active) {
    if constexpr (kLeavesDivision) {
      block.f = f;
      block.side = pull_solved;
    } else {
      set<kMasked>(block.f, adjugate_times(scaled, f) - pull_solved, active);
    }
  }
  struct Solved {
    MBS_CHAIN_INLINE Vec<V> operator()(const B& block) const {
      if constexpr (kLeavesDivision) return Divided<&B::f>()(block) - block.side;
      return read(block.f);
    }
  };
  static constexpr bool kLeavesDivision = std::is_same_v<typename Store::Use, Pair>;  // no masks

  /// Eqs. (4), (2)
  struct Move {
    LargestOf<typename Store::Use>& largest;
    const Mask& active;

    MBS_CHAIN_INLINE void operator()(B& block, const Vec<V>& x) const {
      largest.add(x);
      set<kMasked>(block.f, block.x - (V{} + 0.5) * x, active);
      set<kMasked>(block.u, block.u - x, active);
    }
  };

  /// M + Σ d dᵀ of a point, and its right-hand side but for links.
  MBS_CHAIN_INLINE static Sym<V> point(B& block, const C& data, Vec<V>& f, const Mask& active) {
    f = f + data.mass.times(block.u);
    Sym<V> A;
    for (int j = 0; j < Store::kRods; ++j) {
      const Vec<V> d = data.rods[j].vector(block.x);
      f = f + tension(block.rods[j], data.rods[j].violation(d), active) * d;
      A = j == 0 ? data.mass.plus_square(d) : plus_square(A, d);
    }
    return A;
  }

  /// An eliminated block whose factors are still to be made. They are when the next block's
  /// division has begun: a processor takes the oldest operation that it can do, and these are many.
  struct Pending {
    Sym<V> S;
    Vec<V> z, e;
    V reciprocal;
    V tension;     // of its link
    Vec<V> f;      // its right-hand side without that
    Vec<V> inner;  // what the next one's gets, without that
  };

  MBS_CHAIN_INLINE static void eliminate_block(B& block, const B& next, const C& data,
                                               const Mask& active, V& least, Carry<V>& carry,
                                               Pending& pending) {
    pending.f = data.mass.outer(read(next.u)) - data.force;
    const Sym<V> own = point(block, data, pending.f, active);
    pending.e = data.link.vector(next.x - block.x);
    pending.tension = tension(block.link, data.link.violation(pending.e), active);
    pending.inner = data.mass.inner(block.u);
    pending.reciprocal = eliminate(data.mass, own, pending.e, pending.S, pending.z, least, carry);
  }

  MBS_CHAIN_INLINE static void finish_block(B& block, const C& data, const Pending& pending,
                                            const Mask& active, Carry<V>& carry) {
    Factors<V> factors;
    const Vec<V> y =
        finish(factors, data.mass, pending.S, pending.z, pending.reciprocal, pending.e);
    const Vec<V> f = carry.force + pending.f;
    const V t = pending.tension;
    keep_solution(block, factors.scaled, f, t * y, active);
    const Vec<V> pull = product(t, pending.e);
    carry.force = forward(factors.gain, pending.inner + pull, f - pull);
    set<kMasked>(block.factors.scaled, factors.scaled, active);
    for (int k = 0; k < 4; ++k) set<kMasked>(block.factors.gain[k], factors.gain[k], active);
  }

  /// A sweep inwards that stops twice a block: when it is eliminated, and when it has its factors.
  struct InwardsSweep {
    InwardsSweep(Store& chain, const Mask& active)
        : block(chain.blocks.data()), data(chain.constants.data()), active(active) {
      begin(*block, active);
    }

    MBS_CHAIN_INLINE void eliminate() {
      begin(block[1], active);
      eliminate_block(*block, block[1], **data, active, least, carry, pending);
    }
    MBS_CHAIN_INLINE void complete() {
      finish_block(*block, **data, pending, active, carry);
      ++block;
      ++data;
    }
    MBS_CHAIN_INLINE void finish() { finish_chain(*block, **data, active, least, carry); }

    B* block;
    const C* const* data;
    Mask active;
    Carry<V> carry;
    V least = V{} + 1.0;
    Pending pending;
  };

  /// Eliminates the last block.
  MBS_CHAIN_INLINE static void finish_chain(B& block, const C& data, const Mask& active, V& least,
                                            const Carry<V>& carry) {
    Vec<V> f = Vec<V>{} - data.force;
    const Sym<V> own = point(block, data, f, active);
    Vec<V> x;
    set<kMasked>(block.factors.scaled, meet<typename Store::Use>(own, carry, f, least, x), active);
    set<kMasked>(block.f, x, active);
  }
};

}  // namespace mbs::compiled_chains
