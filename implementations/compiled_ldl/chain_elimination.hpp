// Elimination of one block of the chain, and substitution with its factors.
#pragma once

#include <type_traits>

#include "chain_storage.hpp"

namespace mbs::compiled_ldl::chain {

/// What an eliminated block leaves to the next one inwards.
template <class V>
struct Carry {
  Sym<V> update{};  // σ (e eᵀ − Oᵀ S⁻¹ O)
  V reciprocal{};   // 1/σ
  Vec<V> force{};   // what its right-hand side gains
};

/// Eliminates a block, A = own + what the one before leaves: S = A + e eᵀ, z = adj(A) e. In a
/// single chain S is not made from A, but beside it: only its determinant is what the next block
/// waits for.
template <class V, class Mass>
MBS_CHAIN_INLINE void eliminate(const Mass& mass, const Sym<V>& own, const Vec<V>& e, Sym<V>& S,
                                Vec<V>& z, V& least, Carry<V>& carry) {
  const Sym<V> A = plus(own, carry.reciprocal, carry.update);
  if constexpr (std::is_same_v<V, Pair>) {
    S = plus(plus_square(own, e), carry.reciprocal, carry.update);
  } else {
    S = plus_square(A, e);
  }
  const V sigma = determinant(S);
  const V reciprocal = reciprocal_of(sigma);
  z = adjugate_times(A, e);
  carry.update = mass.update(determinant(A), z, e, S);
  carry.reciprocal = reciprocal;
  least = smaller(least, smaller(S.xx, sigma));
}

/// S⁻¹ and G of a block.
template <class V, class Mass>
MBS_CHAIN_INLINE void finish(Factors<V>& to, const Mass& mass, const Sym<V>& S, const Vec<V>& z,
                             const V& reciprocal, const Vec<V>& e) {
  to.scaled = {reciprocal * S.xx, reciprocal * S.xy, reciprocal * S.yy};
  mass.gain(to.scaled, reciprocal * z, e, to.gain);
}

template <class Use, class V>
MBS_CHAIN_INLINE Vec<V> meet(const Vec<V>& a) {
  return {Lanes<Use>::meet(a.x), Lanes<Use>::meet(a.y)};
}

/// The last block, which the ends of a chain have in common: each has half of its `own`, and of the
/// right-hand side f. An overflow has reached it as a NaN, or is one of its own. Returns S/σ.
template <class Use, class V>
MBS_CHAIN_INLINE Sym<V> meet(const Sym<V>& own, const Carry<V>& carry, const Vec<V>& f, V& least,
                             Vec<V>& c) {
  const V half = V{} + 0.5;
  const V& r = carry.reciprocal;
  const Sym<V> S{Lanes<Use>::meet(half * own.xx + r * carry.update.xx),
                 Lanes<Use>::meet(half * own.xy + r * carry.update.xy),
                 Lanes<Use>::meet(half * own.yy + r * carry.update.yy)};
  const V sigma = determinant(S);
  const V reciprocal = reciprocal_of(sigma);
  least = smaller(least, smaller(S.xx, smaller(sigma, reciprocal)));
  c = reciprocal * adjugate_times(S, meet<Use>(carry.force + half * f));
  return {reciprocal * S.xx, reciprocal * S.xy, reciprocal * S.yy};
}

/// The penalty form's way: d dᵀ and M are added before anything is eliminated.
struct Together {
  template <int kRods, class V, class Mass>
  MBS_CHAIN_INLINE static Sym<V> own(const Mass& mass, const Vec<V>* d) {
    Sym<V> A = mass.plus_square(d[0]);
    for (int j = 1; j < kRods; ++j) A = plus_square(A, d[j]);
    return A;
  }
  template <class V, class Mass>
  MBS_CHAIN_INLINE static void eliminate(const Mass& mass, const Sym<V>& own, const Vec<V>& e,
                                         Sym<V>& S, Vec<V>& z, V& least, Carry<V>& carry) {
    chain::eliminate(mass, own, e, S, z, least, carry);
  }
  template <class Use, class V>
  MBS_CHAIN_INLINE static Sym<V> meet(const Sym<V>& own, const Carry<V>& carry, const Vec<V>& f,
                                      V& least, Vec<V>& c) {
    return chain::meet<Use>(own, carry, f, least, c);
  }
};

/// f − Gᵀ b
template <class V>
MBS_CHAIN_INLINE Vec<V> forward(const V* G, const Vec<V>& f, const Vec<V>& b) {
  return {f.x - G[0] * b.x - G[2] * b.y, f.y - G[1] * b.x - G[3] * b.y};
}

/// c − G x
template <class V>
MBS_CHAIN_INLINE Vec<V> backward(const V* G, const Vec<V>& c, const Vec<V>& x) {
  return {c.x - G[0] * x.x - G[1] * x.y, c.y - G[2] * x.x - G[3] * x.y};
}

/// A sweep inwards with the factors there are. `terms.point(block, data)` is a right-hand side but
/// for links, `terms.link(block, next, data, f, inner)` adds to that of the block and of the next.
template <class Store, class Terms>
MBS_CHAIN_INLINE void substitute_inwards(Store& chain, const Terms& terms) {
  using V = typename Store::V;
  auto* block = chain.blocks.data();
  const auto* data = chain.constants.data();
  auto* const end = block + chain.last;
  if (block == end) {  // a single point
    block->f = adjugate_times(block->factors.scaled, terms.point(*block, **data));
    return;
  }
  Vec<V> before = terms.point(*block, **data);  // the right-hand side of the block before
  Vec<V> inner;                                 // what its link gives
  terms.link(*block, block[1], **data, before, inner);
  block->f = before;
  for (++block, ++data; block != end; ++block, ++data) {
    Vec<V> f = inner + terms.point(*block, **data);
    terms.link(*block, block[1], **data, f, inner);
    before = forward(block[-1].factors.gain, f, before);  // only this waits for the block before
    block->f = before;
  }
  const Vec<V> f = inner + (V{} + 0.5) * terms.point(*block, **data);
  block->f = adjugate_times(block->factors.scaled,
                            meet<typename Store::Use>(forward(block[-1].factors.gain, f, before)));
}

/// The sweep outwards: `apply(block, x)` gets the solution of each block.
template <class Store, class Apply>
MBS_CHAIN_INLINE void substitute_outwards(Store& chain, const Apply& apply) {
  auto* block = chain.blocks.data() + chain.last;
  auto* const begin = chain.blocks.data();
  auto x = block->f;  // of the last block the solution itself
  apply(*block, x);
  while (block != begin) {
    --block;
    x = backward(block->factors.gain, adjugate_times(block->factors.scaled, block->f), x);
    apply(*block, x);
  }
}

/// Two of them by turns, block by block.
template <class Store, class Apply>
MBS_CHAIN_INLINE void substitute_outwards(Store& first, const Apply& apply_first, Store& second,
                                          const Apply& apply_second) {
  auto* a = first.blocks.data() + first.last;
  auto* b = second.blocks.data() + second.last;
  auto* const begin = first.blocks.data();
  auto x = a->f;
  auto y = b->f;
  apply_first(*a, x);
  apply_second(*b, y);
  while (a != begin) {
    --a;
    --b;
    x = backward(a->factors.gain, adjugate_times(a->factors.scaled, a->f), x);
    y = backward(b->factors.gain, adjugate_times(b->factors.scaled, b->f), y);
    apply_first(*a, x);
    apply_second(*b, y);
  }
}

}  // namespace mbs::compiled_ldl::chain
