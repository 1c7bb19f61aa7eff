// Several doubles in one register: what lies in its lanes, and what one cannot write with + and *.
#pragma once

#if defined(__SSE2__)
#include <immintrin.h>
#endif

namespace mbs::compiled_chains {

/// Doubles of a register. In wider vectors compilers reach a number through memory.
#if defined(__AVX512F__)
inline constexpr int kRegisterDoubles = 8;
#elif defined(__AVX__)
inline constexpr int kRegisterDoubles = 4;
#else
inline constexpr int kRegisterDoubles = 2;
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
  static constexpr bool kMagnitudesLoseNaN = false;
  /// In both lanes of a chain, the sum of both.
  MBS_CHAIN_INLINE static V meet(V a) { return a + __builtin_shufflevector(a, a, 1, 0); }
};

template <>
struct Lanes<Wide> {
  using V = double __attribute__((vector_size(8 * kRegisterDoubles)));
  using Mask = long long __attribute__((vector_size(8 * kRegisterDoubles)));
  static constexpr int kChains = kRegisterDoubles / 2;
#if defined(__AVX512DQ__)
  static constexpr bool kMagnitudesLoseNaN = true;
#else
  static constexpr bool kMagnitudesLoseNaN = false;
#endif
  MBS_CHAIN_INLINE static V meet(V a) { return a + other_end(a); }
  /// Of each lane, that of the chain's other end.
  template <class Vector>
  MBS_CHAIN_INLINE static Vector other_end(Vector a) {
#if defined(__AVX512F__)
    return __builtin_shufflevector(a, a, 1, 0, 3, 2, 5, 4, 7, 6);
#elif defined(__AVX__)
    return __builtin_shufflevector(a, a, 1, 0, 3, 2);
#else
    return __builtin_shufflevector(a, a, 1, 0);
#endif
  }
};

/// A number in memory that is used more than once. (Tuned for some processors, GCC fetches numbers
/// of eight doubles anew for every use, and sweeps wait for little else than what they fetch.)
template <class V>
MBS_CHAIN_INLINE V read(V a) {
#if defined(__AVX512F__)
  if constexpr (sizeof(V) == 64) asm("" : "+v"(a));
#endif
  return a;
}

/// A product that is used more than once: fused into each sum, it would be made as often.
template <class V>
MBS_CHAIN_INLINE V product(const V& a, const V& b) {
  return read(V(a * b));
}

/// Has the lanes of a register whose bits are those of `bits` and those of `a`.
template <class V>
MBS_CHAIN_INLINE V masked(const V& bits, const V& a) {
  using Mask = decltype(a == a);
  return (V)((Mask)bits & (Mask)a);
}
template <class V>
void set_all_bits(V& a, int lane) {
  decltype(a == a) bits{};
  bits[lane] = -1;
  a = (V)((decltype(bits))a | bits);
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
// Zen 5 divides eight numbers in 13 cycles, and another eight every fourth one: that keeps little
// else waiting. (GCC 12 takes it for a Zen 3. Not measured on Zen 4.)
#if defined(__AVX512F__) && !defined(__znver3__) && !defined(__znver4__) && !defined(__znver5__)
/// Refined from an estimate r of 14 bits, with δ = 1 − a r: r (1 + δ)(1 + δ²) lacks δ⁴. On Intel's
/// processors as quick as a division for its own result, but it keeps nothing else waiting.
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

#if defined(__AVX512F__)
template <>
MBS_CHAIN_INLINE Lanes<Wide>::V larger<Lanes<Wide>::V>(Lanes<Wide>::V a, Lanes<Wide>::V b) {
  return _mm512_maskz_max_pd(0xff, a, b);
}
#elif defined(__AVX__)
template <>
MBS_CHAIN_INLINE Lanes<Wide>::V larger<Lanes<Wide>::V>(Lanes<Wide>::V a, Lanes<Wide>::V b) {
  return _mm256_max_pd(a, b);
}
#endif

/// The larger one of a ≥ 0 and |b|. If b is a NaN: that, or with kMagnitudesLoseNaN a.
template <class Use>
MBS_CHAIN_INLINE typename Lanes<Use>::V larger_magnitude(typename Lanes<Use>::V a,
                                                         typename Lanes<Use>::V b) {
#if defined(__AVX512DQ__)
  if constexpr (Lanes<Use>::kMagnitudesLoseNaN) return _mm512_maskz_range_pd(0xff, a, b, 0b1011);
#endif
  return larger(a, magnitude<Use>(b));
}

/// The smaller one; the second if there is a NaN.
template <class V>
MBS_CHAIN_INLINE V smaller(V a, V b) {
  return a < b ? a : b;
}

template <class V, class Mask>
MBS_CHAIN_INLINE void keep(V& to, const V& value, const Mask& lanes) {
  to = lanes ? value : to;
}

}  // namespace mbs::compiled_chains
