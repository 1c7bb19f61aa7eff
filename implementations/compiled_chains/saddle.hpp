// Newton's passes of the saddle-point form over a chain, Eq. (12), with the multipliers eliminated.
#pragma once

#include "newton.hpp"
#include "rows.hpp"

namespace mbs::compiled_chains {

/// A point, with what a pass has evaluated of its distances.
template <class V, class Rods>
struct SaddleBlock : RowBlock<V, Rods> {
  V violation[Rods::kMost];
  V link_violation;
};

/// The matrix is T of the penalty form, in which dᵀd and eᵀe are larger than M by 10⁸: they are
/// kept apart, so that determinants are sums of what is positive and M does not drown in them. Nor
/// does λ in violations: README.md, "Saddle-point form".
template <class Store, bool kFirst>
class SaddleNewton {
 public:
  using V = typename Store::V;

  static PassResult<V> pass(Store& chain) {
    PassResult<V> result;
    result.least = inwards(chain);
    LargestOf<typename Store::Use> largest;
    Vec<V> inner;
    const auto move = [&](B& block, const Vec<V>& x) {
      largest.add(x);
      block.x = block.x - (V{} + 0.5) * x;
      block.u = block.u - x;
      for (int j = 0; j < Store::kRods; ++j) {  // the μ of (12)
        block.rods[j] += block.violation[j] - dot(block.d[j], x);
      }
      block.link += block.link_violation - dot(block.e, inner - x);
      inner = x;
    };
    substitute_outwards<Store, decltype(move), &B::f, Solved>(chain, move);
    result.largest = largest.value();
    return result;
  }

 private:
  using B = typename Store::B;
  using C = typename Store::C;

  struct Solved {
    MBS_CHAIN_INLINE Vec<V> operator()(const B& block) const { return read(block.f); }
  };

  MBS_CHAIN_INLINE static void predict(B& block) {
    block.w = block.w + block.u;
    block.x = block.x + block.w;
  }

  MBS_CHAIN_INLINE static V cross(const Vec<V>& a, const Vec<V>& b) {
    return a.x * b.y - a.y * b.x;
  }

  /// det(S + Σ d dᵀ)
  MBS_CHAIN_INLINE static V determinant_with(const Sym<V>& S, const B& block) {
    V result = determinant(S);
    for (int j = 0; j < Store::kRods; ++j) {
      result = result + dot(block.d[j], adjugate_times(S, block.d[j]));
      for (int k = 0; k < j; ++k) {
        const V area = cross(block.d[j], block.d[k]);
        result = result + area * area;
      }
    }
    return result;
  }

  /// The distances of a point to fixed ones, and its right-hand side but for links and violations.
  MBS_CHAIN_INLINE static void point(B& block, const C& data, Vec<V>& f) {
    f = f + data.mass.times(block.u);
    for (int j = 0; j < Store::kRods; ++j) {
      block.d[j] = data.rods[j].vector(block.x);
      block.violation[j] = data.rods[j].violation(block.d[j]);
      f = f + block.rods[j] * block.d[j];
    }
  }

  /// adj(b bᵀ) a
  MBS_CHAIN_INLINE static Vec<V> adjugate_of_square_times(const Vec<V>& b, const Vec<V>& a) {
    return cross(b, a) * Vec<V>(-b.y, b.x);
  }

  /// adj(S + Σ d dᵀ) Σ p d, without adj(d dᵀ) d, which is 0.
  MBS_CHAIN_INLINE static Vec<V> violations_solved(const Sym<V>& S, const B& block) {
    Vec<V> sum{};
    for (int j = 0; j < Store::kRods; ++j) {
      Vec<V> z = adjugate_times(S, block.d[j]);
      for (int k = 0; k < Store::kRods; ++k) {
        if (k != j) z = z + adjugate_of_square_times(block.d[k], block.d[j]);
      }
      sum = sum + block.violation[j] * z;
    }
    return sum;
  }

  MBS_CHAIN_INLINE static void assemble_and_eliminate(B& block, const B& next, const C& data,
                                                      V& least, Carry<V>& carry) {
    Vec<V> f = data.mass.outer(next.u) - data.force;
    point(block, data, f);
    const Vec<V> e = data.link.vector(next.x - block.x);
    block.e = e;
    block.link_violation = data.link.violation(e);
    f = carry.force + (f - block.link * e);

    const Sym<V> light = plus(data.mass.matrix(), carry.reciprocal, carry.update);
    const V delta = determinant_with(light, block);
    Vec<V> z = adjugate_times(light, e);
    V sigma = delta + dot(e, z);
    Sym<V> S = plus_square(light, e);
    Vec<V> solved = violations_solved(light, block);
    for (int j = 0; j < Store::kRods; ++j) {
      const Vec<V>& d = block.d[j];
      const V area = cross(d, e);
      z = z + area * Vec<V>(-d.y, d.x);
      solved = solved + block.violation[j] * area * Vec<V>(e.y, -e.x);
      sigma = sigma + area * area;
      S = plus_square(S, d);
    }
    carry.reciprocal = reciprocal_of(sigma);
    carry.update = data.mass.update(delta, z, e, S);
    least = smaller(least, smaller(S.xx, sigma));
    finish(block.factors, data.mass, S, z, carry.reciprocal, e);
    const Vec<V> x =
        carry.reciprocal * (adjugate_times(S, f) + (solved - block.link_violation * z));
    block.f = x;
    carry.force =
        data.mass.inner(block.u - x) + (block.link + block.link_violation + dot(e, x)) * e;
  }

  static V inwards(Store& chain) {
    B* block = chain.blocks.data();
    const C* const* data = chain.constants.data();
    B* const end = block + chain.last;
    Carry<V> carry;
    V least = V{} + 1.0;
    if (kFirst) predict(*block);
    for (; block != end; ++block, ++data) {
      if (kFirst) predict(block[1]);
      assemble_and_eliminate(*block, block[1], **data, least, carry);
    }
    Vec<V> f = Vec<V>{} - (*data)->force;
    point(*block, **data, f);
    f = f + meet<typename Store::Use>(carry.force);
    Sym<V> S = (*data)->mass.matrix();
    const V& r = carry.reciprocal;
    S.xx = S.xx + Lanes<typename Store::Use>::meet(r * carry.update.xx);
    S.xy = S.xy + Lanes<typename Store::Use>::meet(r * carry.update.xy);
    S.yy = S.yy + Lanes<typename Store::Use>::meet(r * carry.update.yy);
    const V sigma = determinant_with(S, *block);
    const V reciprocal = reciprocal_of(sigma);
    const Vec<V> solved = violations_solved(S, *block);
    for (int j = 0; j < Store::kRods; ++j) S = plus_square(S, block->d[j]);
    block->factors.scaled = {reciprocal * S.xx, reciprocal * S.xy, reciprocal * S.yy};
    block->f = reciprocal * (adjugate_times(S, f) + solved);
    return smaller(least, smaller(S.xx, smaller(sigma, reciprocal)));
  }
};

/// Eq. (13), solved for what v* and a* lack: Φqᵀ times something large would leave its rounding in
/// M's part.
template <class Store>
class SaddleProjection {
 public:
  using V = typename Store::V;
  using B = typename Store::B;

  static void settle(Store& chain) {
    for (B& block : chain.blocks) block.w = block.w + block.u;
  }
  static void velocity(Store& chain) {
    velocity_residual(chain, [](const B& block) { return block.w + block.u; });
    substitute_outwards(chain,
                        [](B& block, const Vec<V>& x) { block.w = (block.w + block.u) + x; });
  }
  static void acceleration(Store& chain) {
    acceleration_residual(chain, [](V& /*multiplier*/, const V& /*rate*/) {});
    substitute_outwards(chain, [](B& block, const Vec<V>& x) { block.u = block.u + x; });
  }
};

}  // namespace mbs::compiled_chains
