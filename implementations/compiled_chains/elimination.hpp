// Elimination of one block of the chain, and substitution with its factors.
#pragma once

#include <type_traits>

#include "storage.hpp"

namespace mbs::compiled_chains {

/// What an eliminated block leaves to the next one inwards. A = I and e = (0, 1), without C, give S
/// = diag(1, 2), σ = 2 and update = diag(0, 1): the next A gains diag(0, ½). As G = diag(0, −½), a
/// right-hand side (0, 4) leaves force = (0, 2).
template <class V>
struct Carry {
  Sym<V> update{};  // σ (e eᵀ − Oᵀ S⁻¹ O)
  V reciprocal{};   // 1/σ
  Vec<V> force{};   // what its right-hand side gains
};

/// Eliminates a block, A = own + what the one before leaves: S = A + e eᵀ, z = adj(A) e. Returns
/// 1/σ of σ = δ + e·z: det S does not fit z to all digits, and the large parts of what crosses a
/// link would not cancel. But det S is there sooner. In a single chain the next block waits for it,
/// and gets 1/det S, which is good enough for its matrix.
template <class V, class Mass>
MBS_CHAIN_INLINE V eliminate(const Mass& mass, const Sym<V>& own, const Vec<V>& e, Sym<V>& S,
                             Vec<V>& z, V& least, Carry<V>& carry) {
  const Sym<V> A = plus(own, carry.reciprocal, carry.update);
  const V delta = determinant(A);
  z = adjugate_times(A, e);
  const V sigma = delta + dot(e, z);
  S = plus_square(A, e);
  V reciprocal;
  if constexpr (std::is_same_v<V, Pair>) {
    const V rough = reciprocal_of(determinant(S));
    reciprocal = rough + rough * ((V{} + 1.0) - sigma * rough);
    carry.reciprocal = rough;
  } else {
    reciprocal = reciprocal_of(sigma);
    carry.reciprocal = reciprocal;
  }
  carry.update = mass.update(delta, z, e, S);
  least = smaller(least, smaller(S.xx, sigma));
  return reciprocal;
}

/// S⁻¹ and G of a block. Returns S⁻¹ e.
template <class V, class Mass>
MBS_CHAIN_INLINE Vec<V> finish(Factors<V>& to, const Mass& mass, const Sym<V>& S, const Vec<V>& z,
                               const V& reciprocal, const Vec<V>& e) {
  to.scaled = {reciprocal * S.xx, reciprocal * S.xy, reciprocal * S.yy};
  const Vec<V> y = reciprocal * z;
  mass.gain(to.scaled, y, e, to.gain);
  return y;
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
  MBS_CHAIN_INLINE static V eliminate(const Mass& mass, const Sym<V>& own, const Vec<V>& e,
                                      Sym<V>& S, Vec<V>& z, V& least, Carry<V>& carry) {
    return compiled_chains::eliminate(mass, own, e, S, z, least, carry);
  }
  template <class Use, class V>
  MBS_CHAIN_INLINE static Sym<V> meet(const Sym<V>& own, const Carry<V>& carry, const Vec<V>& f,
                                      V& least, Vec<V>& c) {
    return compiled_chains::meet<Use>(own, carry, f, least, c);
  }
};

template <class V>
MBS_CHAIN_INLINE V cross(const Vec<V>& a, const Vec<V>& b) {
  return a.x * b.y - a.y * b.x;
}

/// What a block has but for the one before.
template <class V, int kRods>
struct OwnParts {
  Sym<V> mass, rods;  // M, Σ d dᵀ
  V areas{};          // Σ (d_j × d_k)²
  const Vec<V>* d;
};

/// What is larger than M by 10⁷ and more, d dᵀ and e eᵀ, is kept apart in the saddle-point form and
/// the multistep method, so that determinants are sums of what is positive and M does not drown in
/// them.
struct Apart {
  template <int kRods, class V, class Mass>
  MBS_CHAIN_INLINE static OwnParts<V, kRods> own(const Mass& mass, const Vec<V>* d) {
    OwnParts<V, kRods> parts;
    parts.d = d;
    parts.mass = mass.matrix();
    parts.rods = {d[0].x * d[0].x, d[0].x * d[0].y, d[0].y * d[0].y};
    for (int j = 1; j < kRods; ++j) {
      parts.rods = plus_square(parts.rods, d[j]);
      for (int k = 0; k < j; ++k) {
        const V area = cross(d[j], d[k]);
        parts.areas = parts.areas + area * area;
      }
    }
    return parts;
  }

  /// det(L + C), given det C
  template <class V>
  MBS_CHAIN_INLINE static V determinant_with(const Sym<V>& L, const Sym<V>& C, const V& det_c) {
    const V mixed = (det_c + C.yy * L.xx) + C.xx * L.yy;
    return mixed + (L.xx * L.yy - L.xy * (L.xy + (C.xy + C.xy)));
  }

  template <class V, class Mass, int kRods>
  MBS_CHAIN_INLINE static V eliminate(const Mass& mass, const OwnParts<V, kRods>& own,
                                      const Vec<V>& e, Sym<V>& S, Vec<V>& z, V& least,
                                      Carry<V>& carry) {
    const Sym<V> all = plus_square(own.rods, e);
    V areas = own.areas;
    Vec<V> turned{};
    for (int j = 0; j < kRods; ++j) {
      const Vec<V>& d = own.d[j];
      const V area = cross(d, e);
      areas = areas + area * area;
      turned = turned + area * Vec<V>(-d.y, d.x);
    }
    const Sym<V> light = plus(own.mass, carry.reciprocal, carry.update);
    const V sigma = determinant_with(light, all, areas);
    const V reciprocal = reciprocal_of(sigma);
    S = light + all;
    z = turned + adjugate_times(light, e);
    carry.update = mass.update(determinant_with(light, own.rods, own.areas), z, e, S);
    carry.reciprocal = reciprocal;
    least = smaller(least, smaller(S.xx, sigma));
    return reciprocal;
  }

  /// See compiled_chains::meet.
  template <class Use, class V, int kRods>
  MBS_CHAIN_INLINE static Sym<V> meet(const OwnParts<V, kRods>& own, const Carry<V>& carry,
                                      const Vec<V>& f, V& least, Vec<V>& c) {
    const V half = V{} + 0.5;
    const V& r = carry.reciprocal;
    const Sym<V> light{Lanes<Use>::meet(half * own.mass.xx + r * carry.update.xx),
                       Lanes<Use>::meet(half * own.mass.xy + r * carry.update.xy),
                       Lanes<Use>::meet(half * own.mass.yy + r * carry.update.yy)};
    const V sigma = determinant_with(light, own.rods, own.areas);
    const V reciprocal = reciprocal_of(sigma);
    const Sym<V> S = light + own.rods;
    least = smaller(least, smaller(S.xx, smaller(sigma, reciprocal)));
    c = reciprocal * adjugate_times(S, compiled_chains::meet<Use>(carry.force + half * f));
    return {reciprocal * S.xx, reciprocal * S.xy, reciprocal * S.yy};
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

/// S⁻¹ f of a block that keeps its right-hand side f.
template <auto kSide>
struct Divided {
  template <class B>
  MBS_CHAIN_INLINE auto operator()(const B& block) const {
    return adjugate_times(read(block.factors.scaled), read(block.*kSide));
  }
};

/// Two sweeps by turns, block by block: what one waits for is the other's work.
template <class Sweep>
MBS_CHAIN_INLINE void by_turns(Sweep& a, Sweep& b, int blocks) {
  for (int k = 0; k < blocks; ++k) {
    a.advance();
    b.advance();
  }
  a.finish();
  b.finish();
}

/// A sweep inwards with the factors there are. `terms.point(block, data)` is a right-hand side but
/// for links, `terms.link(block, next, data, f, inner)` adds to that of the block and of the next.
/// What remains of it is put into `kSide` of each block.
template <class Store, class Terms, auto kSide>
class InwardsSubstitution {
 public:
  using V = typename Store::V;

  MBS_CHAIN_INLINE InwardsSubstitution(Store& chain, const Terms& terms)
      : terms_(terms), block_(chain.blocks.data()), data_(chain.constants.data()) {
    if (chain.last == 0) return;
    before_ = terms_.point(*block_, **data_);
    terms_.link(*block_, block_[1], **data_, before_, inner_);
    block_->*kSide = before_;
    ++block_;
    ++data_;
  }
  MBS_CHAIN_INLINE void advance() {
    Vec<V> f = inner_ + terms_.point(*block_, **data_);
    terms_.link(*block_, block_[1], **data_, f, inner_);
    before_ = forward(block_[-1].factors.gain, f, before_);  // all that waits for the block before
    block_->*kSide = before_;
    ++block_;
    ++data_;
  }
  /// The last block.
  MBS_CHAIN_INLINE void finish() {
    const Vec<V> f = inner_ + (V{} + 0.5) * terms_.point(*block_, **data_);
    block_->*kSide =
        adjugate_times(block_->factors.scaled,
                       meet<typename Store::Use>(forward(block_[-1].factors.gain, f, before_)));
  }
  MBS_CHAIN_INLINE void finish_single() {
    block_->*kSide = adjugate_times(block_->factors.scaled, terms_.point(*block_, **data_));
  }

 private:
  Terms terms_;
  typename Store::B* block_;
  const typename Store::C* const* data_;
  Vec<V> before_;  // the right-hand side of the block before
  Vec<V> inner_;   // what its link gives
};

template <class Store, class Terms, auto kSide = &Store::B::f>
MBS_CHAIN_INLINE void substitute_inwards(Store& chain, const Terms& terms) {
  InwardsSubstitution<Store, Terms, kSide> sweep(chain, terms);
  if (chain.last == 0) return sweep.finish_single();
  for (int k = 1; k < chain.last; ++k) sweep.advance();
  sweep.finish();
}
template <class Store, class Terms, auto kSide = &Store::B::f>
MBS_CHAIN_INLINE void substitute_inwards(Store& first, const Terms& first_terms, Store& second,
                                         const Terms& second_terms) {
  InwardsSubstitution<Store, Terms, kSide> a(first, first_terms), b(second, second_terms);
  if (first.last == 0) {
    a.finish_single();
    b.finish_single();
  } else {
    by_turns(a, b, first.last - 1);
  }
}

/// The sweep outwards: `apply(block, x)` gets the solution of each block, `Solved` finds S⁻¹ f.
template <class Store, class Apply, auto kSide, class Solved>
class OutwardsSubstitution {
 public:
  using V = typename Store::V;

  MBS_CHAIN_INLINE OutwardsSubstitution(Store& chain, const Apply& apply)
      : apply_(apply), block_(chain.blocks.data() + chain.last), x_(block_->*kSide) {
    apply_(*block_, x_);  // of the last block it is the solution itself
  }
  MBS_CHAIN_INLINE void advance() {
    --block_;
    x_ = backward(block_->factors.gain, Solved()(*block_), x_);
    apply_(*block_, x_);
  }
  MBS_CHAIN_INLINE void finish() {}

 private:
  Apply apply_;
  typename Store::B* block_;
  Vec<V> x_;
};

template <class Store, class Apply, auto kSide = &Store::B::f, class Solved = Divided<kSide>>
MBS_CHAIN_INLINE void substitute_outwards(Store& chain, const Apply& apply) {
  OutwardsSubstitution<Store, Apply, kSide, Solved> sweep(chain, apply);
  for (int k = 0; k < chain.last; ++k) sweep.advance();
}
template <class Store, class Apply, auto kSide = &Store::B::f, class Solved = Divided<kSide>>
MBS_CHAIN_INLINE void substitute_outwards(Store& first, const Apply& apply_first, Store& second,
                                          const Apply& apply_second) {
  OutwardsSubstitution<Store, Apply, kSide, Solved> a(first, apply_first), b(second, apply_second);
  by_turns(a, b, first.last);
}

}  // namespace mbs::compiled_chains
