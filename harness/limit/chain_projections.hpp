// Both projections of the chain, Eq. (6), with the factors of the last pass.
#pragma once

#include "limit/chain.hpp"

namespace mbs::limit {

/// M w* as right-hand side, w* being what Eq. (2) gave; brings the multipliers up to date on the
/// way, from the Phi of the final coordinates.
template <class V>
struct VelocitySide {
  V x, y, wx, wy, from_x, from_y;
  V length, offset;

  explicit VelocitySide(const ChainConstants<V>& constants)
      : length(constants.length), offset(constants.offset) {}

  MBS_LIMIT_INLINE void begin(Block<V>& block) {
    x = load(block.x), y = load(block.y);
    wx = load(block.wx) + load(block.ux), wy = load(block.wy) + load(block.uy);
    from_x = wx - wx, from_y = from_x;
  }
  template <bool kOutermost>
  MBS_LIMIT_INLINE Planar<V> arrive(Block<V>& block, Block<V>& next, const Place<V>& place,
                                    const V& pad) {
    const V own_x = x, own_y = y, own_wx = wx, own_wy = wy, px = from_x, py = from_y;
    begin(next);
    const V ex = x - own_x + offset, ey = y - own_y;
    const V coupler = ex * ex + ey * ey - length, rod = own_x * own_x + own_y * own_y - length;
    store(block.rod, load(block.rod) + (kOutermost ? rod * pad : rod));
    store(block.coupler, load(block.coupler) + (kOutermost ? coupler * pad : coupler));
    from_x = own_wx, from_y = own_wy;
    return {fma(place.mass, own_wx, px + wx), fma(place.mass, own_wy, py + wy)};
  }
  MBS_LIMIT_INLINE Planar<V> middle(Block<V>& block, const Place<V>& place) {
    store(block.rod, load(block.rod) + (x * x + y * y - length));
    return {fma(place.mass, wx, from_x + swapped(from_x)),
            fma(place.mass, wy, from_y + swapped(from_y))};
  }
  static MBS_LIMIT_INLINE void leave(Block<V>& block, const Planar<V>& w) {
    store(block.wx, w.x), store(block.wy, w.y);
  }
};

/// M u* less what the velocities make of the constraints, along the rods of the last pass.
template <class V>
struct AccelerationSide {
  V x, y, wx, wy, ux, uy, from_x, from_y;
  V offset, half;

  explicit AccelerationSide(const ChainConstants<V>& constants)
      : offset(constants.offset), half(constants.half) {}

  MBS_LIMIT_INLINE void take(const Block<V>& block) {
    x = load(block.px), y = load(block.py);
    wx = load(block.wx), wy = load(block.wy);
    ux = load(block.ux), uy = load(block.uy);
  }
  MBS_LIMIT_INLINE void begin(Block<V>& block) {
    take(block);
    from_x = x - x, from_y = from_x;
  }
  template <bool kOutermost>
  MBS_LIMIT_INLINE Planar<V> arrive(Block<V>&, Block<V>& next, const Place<V>& place,
                                    const V& pad) {
    const AccelerationSide own = *this;
    take(next);
    const V ex = x - own.x + offset, ey = y - own.y, dx = wx - own.wx, dy = wy - own.wy;
    const V rod = half * (own.wx * own.wx + own.wy * own.wy);
    const V all = half * (dx * dx + dy * dy);
    const V coupler = kOutermost ? all * pad : all;
    from_x = fnma(coupler, ex, own.ux), from_y = fnma(coupler, ey, own.uy);
    return {fma(coupler, ex, fnma(rod, own.x, fma(place.mass, own.ux, own.from_x + ux))),
            fma(coupler, ey, fnma(rod, own.y, fma(place.mass, own.uy, own.from_y + uy)))};
  }
  MBS_LIMIT_INLINE Planar<V> middle(Block<V>&, const Place<V>& place) {
    const V rod = half * (wx * wx + wy * wy);
    return {fnma(rod, x, fma(place.mass, ux, from_x + swapped(from_x))),
            fnma(rod, y, fma(place.mass, uy, from_y + swapped(from_y)))};
  }
  static MBS_LIMIT_INLINE void leave(Block<V>& block, const Planar<V>& u) {
    store(block.ux, u.x), store(block.uy, u.y);
  }
};

/// c = S^-1 of what arrives at a block, kept for the way back.
template <class V>
MBS_LIMIT_INLINE Planar<V> keep(Factor<V>& factor, const Planar<V>& y) {
  const V ixy = load(factor.sxy);
  const Planar<V> c{fnma(ixy, y.y, load(factor.sxx) * y.x), fnma(ixy, y.x, load(factor.syy) * y.y)};
  store(factor.cx, c.x), store(factor.cy, c.y);
  return c;
}

/// One right-hand side through the factors, inwards and back.
template <class V>
template <class Side>
void Chain<V>::project() {
  Side side(constants_);
  side.begin(blocks_[0]);
  Planar<V> y = side.template arrive<true>(blocks_[0], blocks_[1], first_, constants_.pad);
  keep(factors_[0], y);
  for (std::size_t i = 1; i < depth_; ++i) {
    const Place<V>& place = i == 1 ? second_ : interior_;
    y = inwards(factors_[i - 1], y,
                side.template arrive<false>(blocks_[i], blocks_[i + 1], place, constants_.pad));
    keep(factors_[i], y);
  }
  const V zero = y.x - y.x;
  const Planar<V> both = inwards(factors_[depth_ - 1], y, {zero, zero});
  const Planar<V> arriving = side.middle(blocks_[depth_], middle_);
  y = {arriving.x + (both.x + swapped(both.x)), arriving.y + (both.y + swapped(both.y))};
  Planar<V> found = keep(factors_[depth_], y);
  Side::leave(blocks_[depth_], found);
  for (std::size_t i = depth_; i-- > 0;) {
    found = outwards(factors_[i], found);
    Side::leave(blocks_[i], found);
  }
}

}  // namespace mbs::limit
