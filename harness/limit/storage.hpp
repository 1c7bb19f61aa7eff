// What the chain stores: state, factors and constants of its blocks, two blocks side by side.
#pragma once

#include "limit/pair.hpp"

namespace mbs::limit {

template <class V>
struct Planar {
  V x, y;
};

/// Blocks i and N - i, in the units of README.md. Couplers lead to the next block inwards.
template <class V>
struct Block {
  V x, y;     ///< s (B - A)
  V px, py;   ///< that of the last pass, before its correction
  V ux, uy;   ///< s dt^2/2 a
  V wx, wy;   ///< s dt v between steps; within one, that plus u of the step before
  V rod;      ///< 6 dt^2 lambda of the rod from A to B
  V coupler;  ///< the same of the coupler
};

/// Of T = L D L^T: S the eliminated diagonal block, O = I - e e^T its coupling to the next.
template <class V>
struct Factor {
  V gxx, gxy, gyx, gyy;  ///< S^-1 O
  V sxx, sxy, syy;       ///< S^-1
  V cx, cy;              ///< S^-1 of the right-hand side that arrives here
};

/// What differs between the chain's ends and its interior.
template <class V>
struct Place {
  V mass;    ///< 6 times the diagonal of M, kg
  V weight;  ///< -3 s dt^2 Q_y
};

/// What a pass needs of a block's own state.
template <class V>
struct Own {
  V x, y, ux, uy;
};

/// A block and the coupler behind it, evaluated.
template <class V>
struct Evaluated {
  V ex, ey, exx, exy, eyy;  ///< e and e e^T
  V axx, axy, ayy;          ///< M + d d^T of the block
  V fx, fy;                 ///< its right-hand side, but for what comes from before
  V on_x, on_y;             ///< what goes into that of the next
};

/// A the block's diagonal without the coupler behind it, S with it, both after elimination before.
template <class V>
struct Pivot {
  V axx, axy, ayy, sxx, sxy, syy;
  V rho;  ///< 1 / det S
};

/// A block that is eliminated, but its factor not finished.
template <class V>
struct Eliminated {
  V nxx, nxy, nyy;  ///< times rho: what elimination puts into the next diagonal block
  V rho, zx, zy;    ///< z = adj(S) e
  V sxx, sxy, syy, ex, ey, fx, fy, on_x, on_y;
};

/// side - G^T y of the block before: what arrives at the next block inwards.
template <class V>
MBS_LIMIT_INLINE Planar<V> inwards(const Factor<V>& factor, const Planar<V>& y,
                                   const Planar<V>& side) {
  return {fnma(load(factor.gxx), y.x, side.x) - load(factor.gyx) * y.y,
          fnma(load(factor.gyy), y.y, side.y) - load(factor.gxy) * y.x};
}

/// x = c - G x of the next block inwards.
template <class V>
MBS_LIMIT_INLINE Planar<V> outwards(const Factor<V>& factor, const Planar<V>& next) {
  // A difference of two products is ready sooner than two fused ones after one another.
  return {fnma(load(factor.gxx), next.x, load(factor.cx)) - load(factor.gxy) * next.y,
          fnma(load(factor.gyy), next.y, load(factor.cy)) - load(factor.gyx) * next.x};
}

template <class V>
struct ChainConstants {
  V pad;     ///< {1, 0} if the right lane starts with a block that is not there: keeps it apart
  V length;  ///< s^2
  V offset;  ///< s (A_next - A), x
  V half;
};

}  // namespace mbs::limit
