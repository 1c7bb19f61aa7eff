// The symmetric multistep method on a chain, Eq. (17): its sweeps, with the multipliers eliminated.
#pragma once

#include "chain_apart.hpp"
#include "chain_moments.hpp"

namespace mbs::compiled_ldl::chain {

template <class Store>
class Multistep {
 public:
  using V = typename Store::V;
  using B = typename Store::B;
  using C = typename Store::C;
  using Residual = PositionResidual<Store>;

  /// Steps 1 and 2 and the first half of the first pass: R(q_n), q', w, a. The least pivot.
  MBS_CHAIN_INLINE static V begin(Store& chain, const Ring& ring) {
    const Slots at(ring);
    B* block = chain.blocks.data();
    const C* const* data = chain.constants.data();
    B* const end = block + chain.last;
    Carry<V> carry;
    V least = V{} + 1.0;
    Predicted<V> here;
    predict(*block, at, here);
    if (block != end) {
      Pending before;
      Predicted<V> next;
      predict(block[1], at, next);
      eliminate_block(*block, **data, here, next, least, carry, before);
      for (++block, ++data; block != end; ++block, ++data) {
        here = next;
        predict(block[1], at, next);
        Pending now;
        eliminate_block(*block, **data, here, next, least, carry, now);
        finish_block(block[-1], *data[-1], before, carry);
        before = now;
        before.f = carry.force + before.f;
      }
      finish_block(block[-1], *data[-1], before, carry);
      here = next;
    }
    Vec<V> f = Vec<V>{} - force(**data);
    const auto own = point(*block, **data, here, f);
    block->factors.scaled = Apart::meet<typename Store::Use>(own, carry, f, least, block->f);
    return least;
  }

  /// The first half of a later pass.
  MBS_CHAIN_INLINE static void inwards(Store& chain) { substitute_inwards(chain, Residual{}); }

  /// The second half of a pass: max|2 s Δq|.
  MBS_CHAIN_INLINE static V outwards(Store& chain, const Ring& ring) {
    LargestOf<typename Store::Use> largest;
    substitute_outwards(chain, [&, now = ring.now()](B& block, const Vec<V>& x) {
      const Vec<V> half = (V{} + 0.5) * x;
      Moment<V>& moment = block.moments[now];
      block.x = block.x - half;
      moment.step = moment.step - half;
      moment.pull = moment.pull - x;
      largest.add(x);
    });
    return largest.value();
  }

 private:
  MBS_CHAIN_INLINE static Vec<V> force(const C& data) { return (V{} + 4.0 * kB0) * data.force; }

  /// M + Σ d dᵀ of a point, and its right-hand side but for links.
  MBS_CHAIN_INLINE static auto point(B& block, const C& data, const Predicted<V>& here, Vec<V>& f) {
    f = f + data.mass.times(here.pull);
    for (int j = 0; j < Store::kRods; ++j) {
      const Vec<V> d = data.rods[j].vector(here.from);
      block.d[j] = d;
      f = f + data.rods[j].violation(data.rods[j].vector(here.to)) * d;
    }
    return Apart::own<Store::kRods>(data.mass, block.d);
  }

  /// An eliminated block whose factors are made when the next one's division has begun.
  struct Pending {
    Sym<V> S;
    Vec<V> z, e;
    V reciprocal;
    Vec<V> f;      // its right-hand side
    Vec<V> inner;  // what its link gives to the next one's
  };

  MBS_CHAIN_INLINE static void eliminate_block(B& block, const C& data, const Predicted<V>& here,
                                               const Predicted<V>& next, V& least, Carry<V>& carry,
                                               Pending& pending) {
    Vec<V> f = data.mass.outer(next.pull) - force(data);
    const auto own = point(block, data, here, f);
    pending.e = data.link.vector(next.from - here.from);
    block.e = pending.e;
    const V violation = data.link.violation(data.link.vector(next.to - here.to));
    const Vec<V> pull = violation * pending.e;
    pending.f = f - pull;
    pending.inner = pull + data.mass.inner(here.pull);
    Apart::eliminate(data.mass, own, pending.e, pending.S, pending.z, least, carry);
    pending.reciprocal = carry.reciprocal;
  }

  MBS_CHAIN_INLINE static void finish_block(B& block, const C& data, const Pending& pending,
                                            Carry<V>& carry) {
    Factors<V> factors;
    finish(factors, data.mass, pending.S, pending.z, pending.reciprocal, pending.e);
    block.f = pending.f;
    carry.force = forward(factors.gain, pending.inner, pending.f);
    block.factors.scaled = factors.scaled;
    for (int k = 0; k < 4; ++k) block.factors.gain[k] = factors.gain[k];
  }
};

}  // namespace mbs::compiled_ldl::chain
