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
  V ux, uy;   ///< s dt^2/4 a
  V wx, wy;   ///< s dt/2 v between steps; within one, that plus u of the step before
  V rod;      ///< 3 dt^2 lambda of the rod from A to B
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
  V weight;  ///< -6 s dt^2/4 Q_y
};

/// What elimination hands on to the next block.
template <class V>
struct Carry {
  V x, y, ux, uy;   ///< the next block's own
  V fx, fy;         ///< what this block and its coupler put into its right-hand side
  V nxx, nxy, nyy;  ///< sigma times what they put into its diagonal block
  V rho;            ///< 1 / sigma, sigma = det S
};

/// x = c - G x of the next block inwards.
template <class V>
MBS_LIMIT_INLINE Planar<V> outwards(const Factor<V>& factor, const Planar<V>& next) {
  const V x = fnma(load(factor.gxx), next.x, load(factor.cx));
  const V y = fnma(load(factor.gyx), next.x, load(factor.cy));
  return {fnma(load(factor.gxy), next.y, x), fnma(load(factor.gyy), next.y, y)};
}

template <class V>
struct ChainConstants {
  V pad;     ///< {1, 0} if the right lane starts with a block that is not there: keeps it apart
  V length;  ///< s^2
  V offset;  ///< s (A_next - A), x
  V two, half;
};

}  // namespace mbs::limit
