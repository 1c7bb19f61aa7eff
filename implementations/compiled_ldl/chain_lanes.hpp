// Several doubles in one register, and vectors and symmetric matrices of the plane made of them.
#pragma once

#if defined(__SSE2__)
#include <immintrin.h>
#endif

namespace mbs::compiled_ldl::chain {

#if defined(__AVX512F__)
inline constexpr int kWideLanes = 8;
#elif defined(__AVX__)
inline constexpr int kWideLanes = 4;
#else
inline constexpr int kWideLanes = 2;
#endif

/// One chain: its two ends.
using Pair = double __attribute__((vector_size(16)));
/// As many chains as there is room for, the ends of each side by side. A name of its own, so that
/// it differs from Pair whatever its width.
struct Wide {};

#define MBS_CHAIN_INLINE [[gnu::always_inline]] inline

/// The register V of a use, and what lies in its lanes: chain k has the lanes 2 k, from its first
/// point on, and 2 k + 1, from its last.
template <class Use>
struct Lanes;

template <>
struct Lanes<Pair> {
  using V = Pair;
  using Mask = long long __attribute__((vector_size(16)));
  static constexpr int kChains = 1;
  /// In both lanes of a chain, the sum of both.
  MBS_CHAIN_INLINE static V meet(V a) { return a + __builtin_shufflevector(a, a, 1, 0); }
};

template <>
struct Lanes<Wide> {
  using V = double __attribute__((vector_size(8 * kWideLanes)));
  using Mask = long long __attribute__((vector_size(8 * kWideLanes)));
  static constexpr int kChains = kWideLanes / 2;
  MBS_CHAIN_INLINE static V meet(V a) {
#if defined(__AVX512F__)
    return a + __builtin_shufflevector(a, a, 1, 0, 3, 2, 5, 4, 7, 6);
#elif defined(__AVX__)
    return a + __builtin_shufflevector(a, a, 1, 0, 3, 2);
#else
    return a + __builtin_shufflevector(a, a, 1, 0);
#endif
  }
};

// Vec and Sym are copied member by member: GCC would copy the whole through a wider register, which
// has to wait for the stores of the members.
template <class V>
struct Vec {
  V x{}, y{};

  Vec() = default;
  MBS_CHAIN_INLINE Vec(const V& x, const V& y) : x(x), y(y) {}
  MBS_CHAIN_INLINE Vec(const Vec& other) : x(other.x), y(other.y) {}
  MBS_CHAIN_INLINE Vec& operator=(const Vec& other) {
    x = other.x;
    y = other.y;
    return *this;
  }
};

template <class V>
struct Sym {
  V xx{}, xy{}, yy{};

  Sym() = default;
  MBS_CHAIN_INLINE Sym(const V& xx, const V& xy, const V& yy) : xx(xx), xy(xy), yy(yy) {}
  MBS_CHAIN_INLINE Sym(const Sym& other) : xx(other.xx), xy(other.xy), yy(other.yy) {}
  MBS_CHAIN_INLINE Sym& operator=(const Sym& other) {
    xx = other.xx;
    xy = other.xy;
    yy = other.yy;
    return *this;
  }
};

template <class V>
MBS_CHAIN_INLINE Vec<V> operator+(const Vec<V>& a, const Vec<V>& b) {
  return {a.x + b.x, a.y + b.y};
}
template <class V>
MBS_CHAIN_INLINE Vec<V> operator-(const Vec<V>& a, const Vec<V>& b) {
  return {a.x - b.x, a.y - b.y};
}
template <class V>
MBS_CHAIN_INLINE Vec<V> operator*(const V& a, const Vec<V>& b) {
  return {a * b.x, a * b.y};
}
template <class V>
MBS_CHAIN_INLINE V dot(const Vec<V>& a, const Vec<V>& b) {
  return a.x * b.x + a.y * b.y;
}
template <class V>
MBS_CHAIN_INLINE Vec<V> operator*(const Sym<V>& a, const Vec<V>& b) {
  return {a.xx * b.x + a.xy * b.y, a.xy * b.x + a.yy * b.y};
}
/// adj(a) b
template <class V>
MBS_CHAIN_INLINE Vec<V> adjugate_times(const Sym<V>& a, const Vec<V>& b) {
  return {a.yy * b.x - a.xy * b.y, a.xx * b.y - a.xy * b.x};
}
template <class V>
MBS_CHAIN_INLINE V determinant(const Sym<V>& a) {
  return a.xx * a.yy - a.xy * a.xy;
}
/// a + factor b
template <class V>
MBS_CHAIN_INLINE Sym<V> plus(const Sym<V>& a, const V& factor, const Sym<V>& b) {
  return {a.xx + factor * b.xx, a.xy + factor * b.xy, a.yy + factor * b.yy};
}
/// a + b bᵀ
template <class V>
MBS_CHAIN_INLINE Sym<V> plus_square(const Sym<V>& a, const Vec<V>& b) {
  return {a.xx + b.x * b.x, a.xy + b.x * b.y, a.yy + b.y * b.y};
}

/// |a|, of each lane; by its sign bit, which is no arithmetic.
template <class Use>
MBS_CHAIN_INLINE typename Lanes<Use>::V magnitude(typename Lanes<Use>::V a) {
  using Mask = typename Lanes<Use>::Mask;
  Mask bits = (Mask)a & 0x7fffffffffffffffLL;
  return (typename Lanes<Use>::V)bits;
}
/// 1 / a.
template <class V>
MBS_CHAIN_INLINE V reciprocal_of(const V& a) {
  const V one = V{} + 1.0;
  return one / a;
}
#if defined(__AVX512F__)
/// Refined from an estimate r of 14 bits, with δ = 1 − a r: r (1 + δ)(1 + δ²) lacks δ⁴. As quick as
/// a division for its own result, but it keeps nothing else waiting.
template <>
MBS_CHAIN_INLINE Lanes<Wide>::V reciprocal_of<Lanes<Wide>::V>(const Lanes<Wide>::V& a) {
  using V = Lanes<Wide>::V;
  const V one = V{} + 1.0;
  const V r = _mm512_maskz_rcp14_pd(0xff, a);
  const V error = one - a * r;
  const V better = r + r * error;
  return better + better * (error * error);
}
#endif

/// The larger one; the second if there is a NaN. (GCC makes two instructions of the general form
/// where b is a magnitude.)
template <class V>
MBS_CHAIN_INLINE V larger(V a, V b) {
  return a > b ? a : b;
}
#if defined(__SSE2__)
template <>
MBS_CHAIN_INLINE Pair larger<Pair>(Pair a, Pair b) {
  return _mm_max_pd(a, b);
}
#endif

/// The largest magnitude of what it is given, in each lane; NaN if the last was.
template <class Use>
struct LargestOf {
  using V = typename Lanes<Use>::V;
  Vec<V> most{};

  MBS_CHAIN_INLINE void add(const Vec<V>& a) {
    most.x = larger(most.x, magnitude<Use>(a.x));
    most.y = larger(most.y, magnitude<Use>(a.y));
  }
  [[nodiscard]] MBS_CHAIN_INLINE V value() const { return larger(most.y, larger(most.x, most.y)); }
};

/// The smaller one; the second if there is a NaN.
template <class V>
MBS_CHAIN_INLINE V smaller(V a, V b) {
  return a < b ? a : b;
}

}  // namespace mbs::compiled_ldl::chain
