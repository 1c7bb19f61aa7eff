// Newton's passes of the chain: one sweep inwards that does everything, one back outwards.
#pragma once

#include "limit/chain.hpp"

namespace mbs::limit {

/// A rod's or coupler's force over its direction, from s^2 Phi, and lambda <- lambda + alpha Phi of
/// the pass before, which the same Phi serves: Eq. (1).
template <class V>
template <bool kFirst>
MBS_LIMIT_INLINE V Chain<V>::tension(const V& violation, V& multiplier) const {
  V lambda = load(multiplier);
  if constexpr (!kFirst) {
    lambda = fma(constants_.half, violation, lambda);
    store(multiplier, lambda);
  }
  return fma(constants_.half, violation, lambda);
}

/// Loads the block that comes next; in a step's first pass it is predicted on the way.
template <class V>
template <bool kFirst>
MBS_LIMIT_INLINE void Chain<V>::take_next(Block<V>& next, Carry<V>& carry) const {
  carry.x = load(next.x), carry.y = load(next.y);
  carry.ux = load(next.ux), carry.uy = load(next.uy);
  if constexpr (kFirst) {
    const V wx = load(next.wx) + carry.ux, wy = load(next.wy) + carry.uy;
    carry.x = fma(constants_.two, wx, carry.x), carry.y = fma(constants_.two, wy, carry.y);
    store(next.wx, wx), store(next.wy, wy);
    store(next.x, carry.x), store(next.y, carry.y);
  }
}

/// Evaluates block i and the coupler behind it, Eqs. (3), (5) and (7), and eliminates the block.
template <class V>
template <bool kFirst, bool kPadded>
MBS_LIMIT_INLINE void Chain<V>::eliminate(std::size_t i, const Place<V>& place, Carry<V>& carry) {
  Block<V>& block = blocks_[i];
  const Carry<V> own = carry;
  take_next<kFirst>(blocks_[i + 1], carry);
  const auto kept = [this](const V& a) { return kPadded ? a * constants_.pad : a; };

  const V ex = carry.x - own.x + constants_.offset, ey = carry.y - own.y;
  const V exx = ex * ex, exy = ex * ey, eyy = ey * ey;
  const V dxx = own.x * own.x, dyy = own.y * own.y;
  const V rod = tension<kFirst>(kept(dxx + dyy - constants_.length), block.rod);
  const V coupler = tension<kFirst>(kept(exx + eyy - constants_.length), block.coupler);

  // Eq. (3) for this block, less what was eliminated before it.
  const V fx = fnma(coupler, ex, fma(rod, own.x, fma(place.mass, own.ux, own.fx + carry.ux)));
  const V fy =
      fnma(coupler, ey, fma(rod, own.y, fma(place.mass, own.uy, own.fy + carry.uy + place.weight)));

  // Eq. (5): A without the coupler behind, S with it.
  const V axx0 = dxx + place.mass, axy0 = own.x * own.y, ayy0 = dyy + place.mass;
  const V axx = fma(own.nxx, own.rho, axx0), sxx = fma(own.nxx, own.rho, axx0 + exx);
  const V axy = fma(own.nxy, own.rho, axy0), sxy = fma(own.nxy, own.rho, axy0 + exy);
  const V ayy = fma(own.nyy, own.rho, ayy0), syy = fma(own.nyy, own.rho, ayy0 + eyy);
  const V sigma = fms(sxx, syy, sxy * sxy);
  const V rho = reciprocal(sigma);
  const V delta = fms(axx, ayy, axy * axy);
  const V zx = fms(ayy, ex, axy * ey), zy = fms(axx, ey, axy * ex);
  carry.nxx = kept(fma(delta, exx, fms(ex + ex, zx, syy)));
  carry.nxy = kept(fma(delta, exy, fma(ex, zy, fma(ey, zx, sxy))));
  carry.nyy = kept(fma(delta, eyy, fms(ey + ey, zy, sxx)));
  carry.rho = rho;

  Factor<V>& factor = factors_[i];
  const V ixx = kept(syy * rho), ixy = kept(sxy * rho),
          iyy = kept(sxx * rho);  // S^-1: ixx, -ixy, iyy
  const V tx = zx * rho, ty = zy * rho;
  const V gxx = kept(fnma(tx, ex, ixx)), gxy = kept(fnma(tx, ey, -ixy));
  const V gyx = kept(fnma(ty, ex, -ixy)), gyy = kept(fnma(ty, ey, iyy));
  carry.fx = fnma(gyx, fy, fnma(gxx, fx, fma(coupler, ex, own.ux)));
  carry.fy = fnma(gyy, fy, fnma(gxy, fx, fma(coupler, ey, own.uy)));
  store(factor.gxx, gxx), store(factor.gxy, gxy), store(factor.gyx, gyx), store(factor.gyy, gyy);
  store(factor.sxx, ixx), store(factor.sxy, ixy), store(factor.syy, iyy);
  store(factor.cx, fnma(ixy, fy, ixx * fx)), store(factor.cy, fnma(ixy, fx, iyy * fy));
}

/// The middle block, to which both lanes lead: both hold it and come to the same.
template <class V>
template <bool kFirst>
void Chain<V>::solve_middle(const Carry<V>& carry) {
  Block<V>& block = blocks_[depth_];
  const auto both = [](const V& a) { return a + swapped(a); };
  const V x = carry.x, y = carry.y;
  const V rod = tension<kFirst>(fma(x, x, fms(y, y, constants_.length)), block.rod);
  const V fx = fma(rod, x, fma(middle_.mass, carry.ux, both(carry.fx)));
  const V fy = fma(rod, y, fma(middle_.mass, carry.uy, both(carry.fy) + middle_.weight));
  const V sxx = fma(x, x, both(carry.nxx * carry.rho) + middle_.mass);
  const V sxy = fma(x, y, both(carry.nxy * carry.rho));
  const V syy = fma(y, y, both(carry.nyy * carry.rho) + middle_.mass);
  const V rho = reciprocal(fms(sxx, syy, sxy * sxy));
  Factor<V>& factor = factors_[depth_];
  const V ixx = syy * rho, ixy = sxy * rho, iyy = sxx * rho;
  store(factor.sxx, ixx), store(factor.sxy, ixy), store(factor.syy, iyy);
  store(factor.cx, fnma(ixy, fy, ixx * fx)), store(factor.cy, fnma(ixy, fx, iyy * fy));
}

template <class V>
template <bool kFirst>
void Chain<V>::pass() {
  Carry<V> carry{};
  take_next<kFirst>(blocks_[0], carry);
  carry.rho = constants_.half;  // times nothing
  if (padded()) {
    eliminate<kFirst, true>(0, first_, carry);
  } else {
    eliminate<kFirst, false>(0, first_, carry);
  }
  if (depth_ > 1) eliminate<kFirst, false>(1, second_, carry);
  for (std::size_t i = 2; i < depth_; ++i) eliminate<kFirst, false>(i, interior_, carry);
  solve_middle<kFirst>(carry);
}

/// By Eq. (2) the same for s B, s dt/2 v (later, see Block::wx) and s dt^2/4 a.
template <class V>
MBS_LIMIT_INLINE void change_by(Block<V>& block, const Planar<V>& change) {
  store(block.x, load(block.x) - change.x), store(block.y, load(block.y) - change.y);
  store(block.ux, load(block.ux) - change.x), store(block.uy, load(block.uy) - change.y);
}

/// Whether all changes are within the tolerance: a NaN reaches the last one.
template <class V>
bool Chain<V>::substitute_back() {
  const Factor<V>& middle = factors_[depth_];
  Planar<V> change{load(middle.cx), load(middle.cy)};
  V most = larger_magnitude(change.x, change.y);
  change_by(blocks_[depth_], change);
  for (std::size_t i = depth_; i-- > 0;) {
    change = outwards(factors_[i], change);
    change_by(blocks_[i], change);
    most = larger_magnitude(larger_magnitude(most, change.x), change.y);
  }
  return lane(most, 0) <= tolerance_ && lane(most, 1) <= tolerance_;
}

}  // namespace mbs::limit
