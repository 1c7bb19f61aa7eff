// What a program computes with: double, float, or a register of doubles side by side, one a
// simulation; how many doubles a register holds.
#pragma once

#include <cmath>
#include <cstddef>
#include <new>
#include <vector>

namespace mbs::compiled_ldl {

/// Doubles of a register. In wider vectors compilers reach a number through memory.
#if defined(__AVX512F__)
inline constexpr int kRegisterDoubles = 8;
#elif defined(__AVX__)
inline constexpr int kRegisterDoubles = 4;
#else
inline constexpr int kRegisterDoubles = 2;
#endif

/// As many doubles as a register holds, one of each of so many simulations.
struct Lanes {
  static constexpr int kCount = kRegisterDoubles;
  using Vector __attribute__((vector_size(8 * kRegisterDoubles), may_alias)) = double;
  Vector v;

  Lanes() = default;
  Lanes(double x) : v(Vector{} + x) {}  // NOLINT: a number is the same in every lane
  static Lanes of(const Vector& v) {
    Lanes x;
    x.v = v;
    return x;
  }
  Lanes& operator+=(const Lanes& b) { return v += b.v, *this; }
  Lanes& operator-=(const Lanes& b) { return v -= b.v, *this; }
  Lanes& operator*=(const Lanes& b) { return v *= b.v, *this; }
};
inline Lanes operator+(const Lanes& a, const Lanes& b) { return Lanes::of(a.v + b.v); }
inline Lanes operator-(const Lanes& a, const Lanes& b) { return Lanes::of(a.v - b.v); }
inline Lanes operator*(const Lanes& a, const Lanes& b) { return Lanes::of(a.v * b.v); }
inline Lanes operator/(const Lanes& a, const Lanes& b) { return Lanes::of(a.v / b.v); }
inline Lanes operator-(const Lanes& a) { return Lanes::of(-a.v); }

template <typename S>
inline constexpr int kLanesOf = 1;
template <>
inline constexpr int kLanesOf<Lanes> = Lanes::kCount;

inline double lane(const Lanes& x, int i) { return x.v[i]; }
inline double lane(double x, int /*i*/) { return x; }
inline double lane(float x, int /*i*/) { return x; }
inline void set_lane(Lanes& x, int i, double value) { x.v[i] = value; }
inline void set_lane(double& x, int /*i*/, double value) { x = value; }
inline void set_lane(float& x, int /*i*/, double value) { x = static_cast<float>(value); }

/// The scalar function f in every lane.
template <typename S, typename Function>
S each(const S& x, Function f) {
  if constexpr (kLanesOf<S> == 1) {
    return static_cast<S>(f(x));
  } else {
    S y = 0.0;
    for (int i = 0; i < kLanesOf<S>; ++i) y.v[i] = f(x.v[i]);
    return y;
  }
}
template <typename S, typename Function>
S each(const S& x, const S& y, Function f) {
  if constexpr (kLanesOf<S> == 1) {
    return static_cast<S>(f(x, y));
  } else {
    S z = 0.0;
    for (int i = 0; i < kLanesOf<S>; ++i) z.v[i] = f(x.v[i], y.v[i]);
    return z;
  }
}

inline double magnitude(double x) { return std::fabs(x); }
inline float magnitude(float x) { return std::fabs(x); }
inline Lanes magnitude(const Lanes& x) { return Lanes::of(x.v < 0.0 ? -x.v : x.v); }
/// The larger one; `a` if b is NaN.
inline double larger(double a, double b) { return b > a ? b : a; }
inline float larger(float a, float b) { return b > a ? b : a; }
inline Lanes larger(const Lanes& a, const Lanes& b) { return Lanes::of(b.v > a.v ? b.v : a.v); }

/// True (all bits) in some of the lanes.
using LaneMask = long long __attribute__((vector_size(8 * kRegisterDoubles)));
inline bool any(const LaneMask& mask) {
  long long all = 0;
  for (int i = 0; i < Lanes::kCount; ++i) all |= mask[i];
  return all != 0;
}
/// x where the mask is true, else y.
inline Lanes select(const LaneMask& mask, const Lanes& x, const Lanes& y = 0.0) {
  return Lanes::of(mask ? x.v : y.v);
}

/// Begins on a cache line.
template <typename T>
struct Aligned {
  using value_type = T;
  Aligned() = default;
  template <typename U>
  Aligned(const Aligned<U>&) {}  // NOLINT: the usual rebinding
  T* allocate(std::size_t count) {
    return static_cast<T*>(::operator new(count * sizeof(T), std::align_val_t(64)));
  }
  void deallocate(T* p, std::size_t) { ::operator delete(p, std::align_val_t(64)); }
  bool operator==(const Aligned&) const { return true; }
};
template <typename T>
using Array = std::vector<T, Aligned<T>>;

/// body(i) for 0 … padded - 1, by vectors if there are many. Few are taken one at a time: a
/// vector's load would have to wait until the narrower stores before it have reached the cache.
template <typename Body>
inline void for_each_row(int size, int padded, Body body) {
  if (size > 16) {
    for (int i = 0; i < padded; ++i) body(i);
    return;
  }
  for (int i = 0; i < size; ++i) {
    body(i);
    asm volatile("" : : : "memory");  // keeps the compiler from making vectors
  }
}

inline void copy_where(const LaneMask& mask, const Array<Lanes>& from, Array<Lanes>& to) {
  for (std::size_t i = 0; i < to.size(); ++i) to[i] = select(mask, from[i], to[i]);
}

}  // namespace mbs::compiled_ldl
