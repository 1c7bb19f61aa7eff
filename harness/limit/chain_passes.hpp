// Newton's passes of the chain: one sweep inwards that does everything, one back outwards.
#pragma once

#include "limit/chain.hpp"
#include "limit/elimination.hpp"

namespace mbs::limit {

/// Twice a rod's or coupler's force over its direction, from s^2 Phi; and lambda <- lambda + alpha
/// Phi of the pass before, which the same Phi serves: Eq. (1).
template <class V>
template <bool kFirst>
MBS_LIMIT_INLINE V Chain<V>::tension(const V& violation, V& multiplier) const {
  V lambda = load(multiplier);
  if constexpr (!kFirst) {
    lambda = lambda + violation;
    store(multiplier, lambda);
  }
  return lambda + violation;
}

/// A block's own numbers; in a step's first pass they are predicted on the way.
template <class V>
template <bool kFirst>
MBS_LIMIT_INLINE Own<V> Chain<V>::take(Block<V>& block) const {
  Own<V> own{load(block.x), load(block.y), load(block.ux), load(block.uy)};
  if constexpr (kFirst) {
    const V wx = load(block.wx) + own.ux, wy = load(block.wy) + own.uy;
    own.x = own.x + wx, own.y = own.y + wy;
    store(block.wx, wx), store(block.wy, wy);
    store(block.x, own.x), store(block.y, own.y);
  }
  return own;
}

/// Block i, whose own numbers are in `own`, and the coupler behind it: Eqs. (3), (5) and (7), but
/// for what elimination brings.
template <class V>
template <bool kFirst, bool kPadded>
MBS_LIMIT_INLINE Evaluated<V> Chain<V>::evaluate(std::size_t i, const Place<V>& place,
                                                 Own<V>& own) {
  Block<V>& block = blocks_[i];
  const Own<V> next = take<kFirst>(blocks_[i + 1]);
  const auto kept = [this](const V& a) { return kPadded ? a * constants_.pad : a; };
  Evaluated<V> result;
  const V ex = next.x - own.x + constants_.offset, ey = next.y - own.y;
  const V exx = ex * ex, eyy = ey * ey, dxx = own.x * own.x, dyy = own.y * own.y;
  const V rod = tension<kFirst>(kept(dxx + dyy - constants_.length), block.rod);
  const V coupler = tension<kFirst>(kept(exx + eyy - constants_.length), block.coupler);
  const V pull_x = coupler * ex, pull_y = coupler * ey;
  result.fx = fma(rod, own.x, fma(place.mass, own.ux, next.ux - pull_x));
  result.fy = fma(rod, own.y, fma(place.mass, own.uy, next.uy - pull_y + place.weight));
  result.on_x = own.ux + pull_x, result.on_y = own.uy + pull_y;
  result.ex = ex, result.ey = ey, result.exx = exx, result.exy = ex * ey, result.eyy = eyy;
  result.axx = dxx + place.mass, result.axy = own.x * own.y, result.ayy = dyy + place.mass;
  own = next;
  return result;
}

/// Takes up what the last block handed on, and gets the one division of this one under way.
template <class V>
template <bool kPadded>
MBS_LIMIT_INLINE Pivot<V> Chain<V>::pivot(const Evaluated<V>& at, const Eliminated<V>& last) const {
  Pivot<V> result;
  result.axx = fma(last.nxx, last.rho, at.axx),
  result.sxx = fma(last.nxx, last.rho, at.axx + at.exx);
  result.axy = fma(last.nxy, last.rho, at.axy),
  result.sxy = fma(last.nxy, last.rho, at.axy + at.exy);
  result.ayy = fma(last.nyy, last.rho, at.ayy),
  result.syy = fma(last.nyy, last.rho, at.ayy + at.eyy);
  result.rho = reciprocal(result.sxx * result.syy - result.sxy * result.sxy);
  if constexpr (kPadded) result.rho = result.rho * constants_.pad;
  return result;
}

/// The middle block, to which both lanes lead: both hold it and come to the same.
template <class V>
template <bool kFirst>
MBS_LIMIT_INLINE void Chain<V>::solve_middle(const Own<V>& own, const Eliminated<V>& last,
                                             Factor<V>& outer) {
  const auto both = [](const V& a) { return a + swapped(a); };
  const V x = own.x, y = own.y;
  const V sxx = fma(x, x, both(last.nxx * last.rho) + middle_.mass);
  const V sxy = fma(x, y, both(last.nxy * last.rho));
  const V syy = fma(y, y, both(last.nyy * last.rho) + middle_.mass);
  const V rho = reciprocal(sxx * syy - sxy * sxy);
  const Planar<V> left = finish(last, outer);
  const V rod = tension<kFirst>(x * x + y * y - constants_.length, blocks_[depth_].rod);
  const V fx = fma(rod, x, fma(middle_.mass, own.ux, both(left.x)));
  const V fy = fma(rod, y, fma(middle_.mass, own.uy, both(left.y) + middle_.weight));
  Factor<V>& factor = factors_[depth_];
  const V ixx = syy * rho, ixy = sxy * rho, iyy = sxx * rho;
  store(factor.sxx, ixx), store(factor.sxy, ixy), store(factor.syy, iyy);
  store(factor.cx, fnma(ixy, fy, ixx * fx)), store(factor.cy, fnma(ixy, fx, iyy * fy));
}

/// Processors take the oldest instruction that is ready. So that none delays the chain of
/// divisions, a block's factor is finished when the next block's division is under way.
template <class V>
template <bool kFirst, bool kPadded>
void Chain<V>::sweep() {
  Own<V> own = take<kFirst>(blocks_[0]);
  Evaluated<V> at = evaluate<kFirst, kPadded>(0, first_, own);
  Eliminated<V> last{};
  Pivot<V> S = pivot<kPadded>(at, last);
  last = eliminate(at, S, at.fx, at.fy);
  for (std::size_t i = 1; i < depth_; ++i) {
    at = evaluate<kFirst, false>(i, i == 1 ? second_ : interior_, own);
    S = pivot<false>(at, last);
    const Planar<V> left = finish(last, factors_[i - 1]);
    last = eliminate(at, S, at.fx + left.x, at.fy + left.y);
  }
  solve_middle<kFirst>(own, last, factors_[depth_ - 1]);
}

template <class V>
template <bool kFirst>
void Chain<V>::pass() {
  if (padded()) {
    sweep<kFirst, true>();
  } else {
    sweep<kFirst, false>();
  }
}

/// Eq. (2), from 2 s Delta q; that of v follows later, see Block::wx.
template <class V>
MBS_LIMIT_INLINE void change_by(Block<V>& block, const Planar<V>& change, const V& half) {
  const V x = load(block.x), y = load(block.y);
  store(block.px, x), store(block.py, y);
  store(block.x, fnma(half, change.x, x)), store(block.y, fnma(half, change.y, y));
  store(block.ux, load(block.ux) - change.x), store(block.uy, load(block.uy) - change.y);
}

/// Whether all changes are within the tolerance: a NaN reaches the last one.
template <class V>
bool Chain<V>::substitute_back() {
  const Factor<V>& middle = factors_[depth_];
  Planar<V> change{load(middle.cx), load(middle.cy)};
  V most = larger_magnitude(change.x, change.y);
  change_by(blocks_[depth_], change, constants_.half);
  for (std::size_t i = depth_; i-- > 0;) {
    change = outwards(factors_[i], change);
    change_by(blocks_[i], change, constants_.half);
    most = larger_magnitude(larger_magnitude(most, change.x), change.y);
  }
  return lane(most, 0) <= tolerance_ && lane(most, 1) <= tolerance_;
}

}  // namespace mbs::limit
