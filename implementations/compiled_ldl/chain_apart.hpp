// Elimination of a block in which d dᵀ and e eᵀ are larger than M by 10⁷ and more: they are kept
// apart, so that determinants are sums of what is positive and M does not drown in them.
#pragma once

#include "chain_elimination.hpp"

namespace mbs::compiled_ldl::chain {

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
  MBS_CHAIN_INLINE static void eliminate(const Mass& mass, const OwnParts<V, kRods>& own,
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
  }

  /// See chain::meet.
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
    c = reciprocal * adjugate_times(S, chain::meet<Use>(carry.force + half * f));
    return {reciprocal * S.xx, reciprocal * S.xy, reciprocal * S.yy};
  }
};

}  // namespace mbs::compiled_ldl::chain
