// Vectors and symmetric matrices of the plane whose numbers are registers.
#pragma once

#include "lanes.hpp"

namespace mbs::compiled_chains {

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

/// See read() of a number.
template <class V>
MBS_CHAIN_INLINE Vec<V> read(const Vec<V>& a) {
  return {read(a.x), read(a.y)};
}
template <class V>
MBS_CHAIN_INLINE Sym<V> read(const Sym<V>& a) {
  return {read(a.xx), read(a.xy), read(a.yy)};
}

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
/// See product() of numbers.
template <class V>
MBS_CHAIN_INLINE Vec<V> product(const V& a, const Vec<V>& b) {
  return {product(a, b.x), product(a, b.y)};
}
template <class V>
MBS_CHAIN_INLINE Vec<V> masked(const V& bits, const Vec<V>& a) {
  return {masked(bits, a.x), masked(bits, a.y)};
}
template <class V>
MBS_CHAIN_INLINE V dot(const Vec<V>& a, const Vec<V>& b) {
  return a.x * b.x + a.y * b.y;
}
template <class V>
MBS_CHAIN_INLINE Sym<V> operator+(const Sym<V>& a, const Sym<V>& b) {
  return {a.xx + b.xx, a.xy + b.xy, a.yy + b.yy};
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

/// The largest magnitude of what it is given, in each lane; NaN if the last was.
template <class Use>
struct LargestOf {
  using V = typename Lanes<Use>::V;
  Vec<V> most{};
  Vec<V> last{};

  MBS_CHAIN_INLINE void add(const Vec<V>& a) {
    most.x = larger_magnitude<Use>(most.x, a.x);
    most.y = larger_magnitude<Use>(most.y, a.y);
    last = a;
  }
  [[nodiscard]] MBS_CHAIN_INLINE V value() const {
    const V most_of_all = larger(most.y, larger(most.x, most.y));
    if (!Lanes<Use>::kMagnitudesLoseNaN) return most_of_all;
    return larger(larger(most_of_all, magnitude<Use>(last.x)), magnitude<Use>(last.y));
  }
};

template <class V, class Mask>
MBS_CHAIN_INLINE void keep(Vec<V>& to, const Vec<V>& value, const Mask& lanes) {
  keep(to.x, value.x, lanes);
  keep(to.y, value.y, lanes);
}
template <class V, class Mask>
MBS_CHAIN_INLINE void keep(Sym<V>& to, const Sym<V>& value, const Mask& lanes) {
  keep(to.xx, value.xx, lanes);
  keep(to.xy, value.xy, lanes);
  keep(to.yy, value.yy, lanes);
}
/// Sets, with `kMasked` only the lanes whose bits are all set.
template <bool kMasked, class T, class Mask>
MBS_CHAIN_INLINE void set(T& to, const T& value, const Mask& lanes) {
  if constexpr (kMasked) {
    keep(to, value, lanes);
  } else {
    to = value;
  }
}

}  // namespace mbs::compiled_chains
