// Two doubles in one register: the same quantity at both ends of the chain.
#pragma once

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace mbs::limit {

#define MBS_LIMIT_INLINE inline __attribute__((always_inline))

/// Lane 0 belongs to the chain from the left end, lane 1 to the one from the right end.
using Pair = double __attribute__((vector_size(16)));

template <class V>
V make(double left, double right);
template <>
MBS_LIMIT_INLINE Pair make<Pair>(double left, double right) {
  return Pair{left, right};
}
MBS_LIMIT_INLINE double lane(const Pair& a, int which) { return a[which]; }
MBS_LIMIT_INLINE void set_lane(Pair& a, int which, double value) { a[which] = value; }

MBS_LIMIT_INLINE Pair load(const Pair& place) { return place; }
MBS_LIMIT_INLINE void store(Pair& place, const Pair& value) { place = value; }

// One expression each, so that compilers contract them where the processor has the instruction.
MBS_LIMIT_INLINE Pair fma(const Pair& a, const Pair& b, const Pair& c) { return a * b + c; }
MBS_LIMIT_INLINE Pair fms(const Pair& a, const Pair& b, const Pair& c) { return a * b - c; }
MBS_LIMIT_INLINE Pair fnma(const Pair& a, const Pair& b, const Pair& c) { return c - a * b; }

MBS_LIMIT_INLINE Pair reciprocal(const Pair& a) { return 1.0 / a; }
MBS_LIMIT_INLINE Pair swapped(const Pair& a) { return Pair{a[1], a[0]}; }

/// The larger of `most` and |x| in each lane; |x| where either is not a number.
MBS_LIMIT_INLINE Pair larger_magnitude(const Pair& most, const Pair& x) {
#if defined(__SSE2__)
  return _mm_max_pd(most, _mm_andnot_pd(_mm_set1_pd(-0.0), x));
#else
  const auto pick = [](double m, double v) {
    return m > __builtin_fabs(v) ? m : __builtin_fabs(v);
  };
  return Pair{pick(most[0], x[0]), pick(most[1], x[1])};
#endif
}

}  // namespace mbs::limit
