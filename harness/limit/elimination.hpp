// Elimination of one 2 x 2 block: what it leaves to the next one, and its factor.
#pragma once

#include "limit/storage.hpp"

namespace mbs::limit {

/// What a block hands on.
template <class V>
MBS_LIMIT_INLINE Eliminated<V> eliminate(const Evaluated<V>& at, const Pivot<V>& S, const V& fx,
                                         const V& fy) {
  Eliminated<V> result;
  const V delta = fms(S.axx, S.ayy, S.axy * S.axy);
  const V zx = fms(S.ayy, at.ex, S.axy * at.ey), zy = fms(S.axx, at.ey, S.axy * at.ex);
  result.nxx = fma(delta, at.exx, fms(at.ex + at.ex, zx, S.syy));
  result.nxy = fma(delta, at.exy, fma(at.ex, zy, fma(at.ey, zx, S.sxy)));
  result.nyy = fma(delta, at.eyy, fms(at.ey + at.ey, zy, S.sxx));
  result.rho = S.rho, result.zx = zx, result.zy = zy;
  result.sxx = S.sxx, result.sxy = S.sxy, result.syy = S.syy, result.ex = at.ex, result.ey = at.ey;
  result.fx = fx, result.fy = fy, result.on_x = at.on_x, result.on_y = at.on_y;
  return result;
}

/// The factor of a block, once its division is done; what its elimination leaves in the
/// right-hand side of the next.
template <class V>
MBS_LIMIT_INLINE Planar<V> finish(const Eliminated<V>& block, Factor<V>& factor) {
  const V ixx = block.syy * block.rho, ixy = block.sxy * block.rho, iyy = block.sxx * block.rho;
  const V tx = block.zx * block.rho, ty = block.zy * block.rho;
  const V gxx = fnma(tx, block.ex, ixx), gxy = fnma(tx, block.ey, -ixy);
  const V gyx = fnma(ty, block.ex, -ixy), gyy = fnma(ty, block.ey, iyy);
  const V fx = block.fx, fy = block.fy;
  store(factor.gxx, gxx), store(factor.gxy, gxy), store(factor.gyx, gyx), store(factor.gyy, gyy);
  store(factor.sxx, ixx), store(factor.sxy, ixy), store(factor.syy, iyy);
  store(factor.cx, fnma(ixy, fy, ixx * fx)), store(factor.cy, fnma(ixy, fx, iyy * fy));
  return {fnma(gxx, fx, block.on_x) - gyx * fy, fnma(gyy, fy, block.on_y) - gxy * fx};
}

}  // namespace mbs::limit
