// Blocks of M: multiples of the identity, which rods give, or any.
#pragma once

#include <array>

#include "planar.hpp"

namespace mbs::compiled_chains {

/// m I at a point.
template <class V>
struct PointMass {
  V m;

  MBS_CHAIN_INLINE Sym<V> matrix() const { return {m, V{}, m}; }
  MBS_CHAIN_INLINE Sym<V> plus_square(const Vec<V>& d) const {
    const V diagonal = read(m);
    return {diagonal + d.x * d.x, d.x * d.y, diagonal + d.y * d.y};
  }
  MBS_CHAIN_INLINE Vec<V> times(const Vec<V>& v) const { return read(m) * v; }
};

/// c I between it (outer) and the next one inwards (inner).
template <class V>
struct IsotropicMass : PointMass<V> {
  V c, square;  // c, c²

  void set(int lane, const std::array<double, 3>& mass, const std::array<double, 4>& coupling) {
    this->m[lane] = mass[0];
    c[lane] = coupling[0];
    square[lane] = coupling[0] * coupling[0];
  }
  /// C v, of the inner point's v
  MBS_CHAIN_INLINE Vec<V> outer(const Vec<V>& v) const { return read(c) * v; }
  /// Cᵀ v, of the outer point's v
  MBS_CHAIN_INLINE Vec<V> inner(const Vec<V>& v) const { return read(c) * v; }
  /// δ e eᵀ + Cᵀz eᵀ + e zᵀC − Cᵀ adj(S) C
  MBS_CHAIN_INLINE Sym<V> update(const V& delta, const Vec<V>& z, const Vec<V>& e,
                                 const Sym<V>& S) const {
    const V k = read(square);
    const Vec<V> y = product(read(c), z);
    const Vec<V> h{delta * e.x + y.x, delta * e.y + y.y};
    const Vec<V> g = h + y;
    return {g.x * e.x - k * S.yy, h.x * e.y + (y.y * e.x + k * S.xy), g.y * e.y - k * S.xx};
  }
  /// G = S⁻¹ C − y eᵀ, given S/σ
  MBS_CHAIN_INLINE void gain(const Sym<V>& R, const Vec<V>& y, const Vec<V>& e, V (&G)[4]) const {
    const V k = read(c);
    const V xy = product(k, R.xy);
    G[0] = k * R.yy - y.x * e.x;
    G[1] = -xy - y.x * e.y;
    G[2] = -xy - y.y * e.x;
    G[3] = k * R.xx - y.y * e.y;
  }
};

/// The same where c is 1 everywhere: Units sees to that.
template <class V>
struct UniformMass : PointMass<V> {
  void set(int lane, const std::array<double, 3>& mass, const std::array<double, 4>& /*coupling*/) {
    this->m[lane] = mass[0];
  }
  MBS_CHAIN_INLINE const Vec<V>& outer(const Vec<V>& v) const { return v; }
  MBS_CHAIN_INLINE const Vec<V>& inner(const Vec<V>& v) const { return v; }
  MBS_CHAIN_INLINE Sym<V> update(const V& delta, const Vec<V>& z, const Vec<V>& e,
                                 const Sym<V>& S) const {
    const Vec<V> h{delta * e.x + z.x, delta * e.y + z.y};
    const Vec<V> g = h + z;
    return {g.x * e.x - S.yy, h.x * e.y + (z.y * e.x + S.xy), g.y * e.y - S.xx};
  }
  MBS_CHAIN_INLINE void gain(const Sym<V>& R, const Vec<V>& y, const Vec<V>& e, V (&G)[4]) const {
    G[0] = R.yy - y.x * e.x;
    G[1] = -R.xy - y.x * e.y;
    G[2] = -R.xy - y.y * e.x;
    G[3] = R.xx - y.y * e.y;
  }
};

/// Any symmetric block at a point, any block between two.
template <class V>
struct GeneralMass {
  Sym<V> m;
  V c[4];

  void set(int lane, const std::array<double, 3>& mass, const std::array<double, 4>& coupling) {
    m.xx[lane] = mass[0];
    m.xy[lane] = mass[1];
    m.yy[lane] = mass[2];
    for (int k = 0; k < 4; ++k) c[k][lane] = coupling[k];
  }
  MBS_CHAIN_INLINE const Sym<V>& matrix() const { return m; }
  MBS_CHAIN_INLINE Sym<V> plus_square(const Vec<V>& d) const {
    return compiled_chains::plus_square(m, d);
  }
  MBS_CHAIN_INLINE Vec<V> times(const Vec<V>& v) const { return m * v; }
  MBS_CHAIN_INLINE Vec<V> outer(const Vec<V>& v) const {
    return {c[0] * v.x + c[1] * v.y, c[2] * v.x + c[3] * v.y};
  }
  MBS_CHAIN_INLINE Vec<V> inner(const Vec<V>& v) const {
    return {c[0] * v.x + c[2] * v.y, c[1] * v.x + c[3] * v.y};
  }
  MBS_CHAIN_INLINE Sym<V> update(const V& delta, const Vec<V>& z, const Vec<V>& e,
                                 const Sym<V>& S) const {
    const Vec<V> first = adjugate_times(S, Vec<V>{c[0], c[2]});  // adj(S) times columns of C
    const Vec<V> second = adjugate_times(S, Vec<V>{c[1], c[3]});
    const Vec<V> y = inner(z);
    const Vec<V> h{delta * e.x + y.x, delta * e.y + y.y};
    return {h.x * e.x + (y.x * e.x - (c[0] * first.x + c[2] * first.y)),
            h.x * e.y + (y.y * e.x - (c[0] * second.x + c[2] * second.y)),
            h.y * e.y + (y.y * e.y - (c[1] * second.x + c[3] * second.y))};
  }
  MBS_CHAIN_INLINE void gain(const Sym<V>& R, const Vec<V>& y, const Vec<V>& e, V (&G)[4]) const {
    G[0] = R.yy * c[0] - R.xy * c[2] - y.x * e.x;
    G[1] = R.yy * c[1] - R.xy * c[3] - y.x * e.y;
    G[2] = R.xx * c[2] - R.xy * c[0] - y.y * e.x;
    G[3] = R.xx * c[3] - R.xy * c[1] - y.y * e.y;
  }
};

}  // namespace mbs::compiled_chains
