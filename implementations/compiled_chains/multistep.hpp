// The symmetric multistep method on a chain, Eq. (17): what it keeps of earlier steps, what it
// makes of that, and its sweeps, with the multipliers eliminated.
#pragma once

#include <array>

#include "elimination.hpp"
#include "rows.hpp"

namespace mbs::compiled_chains {

/// So many steps and accelerations make the next step.
inline constexpr int kPast = 5;

/// Coefficients of Eq. (17). c is 1/10 (1, −2, 2, −1, 10), b is b₀ (1, …, 1) where not given.
inline constexpr double kB0 = 3331.0 / 2400.0;
inline constexpr double kB1 = -73.0 / 300.0;  // and b₃
inline constexpr double kB2 = 3133.0 / 1200.0;
inline constexpr std::array<double, kPast> kVelocity = {475.0 / 288.0, -247.0 / 90.0, 631.0 / 240.0,
                                                        -58.0 / 45.0, 367.0 / 1440.0};

/// A step and the acceleration that it began with: what half a pass's x and a whole one is taken
/// from. Of a point that moves by a metre along x in every step all five moments are {(ℓ, 0), (0,
/// 0)}, and predict() finds the same again.
template <class V>
struct Moment {
  Vec<V> step;  // s w
  Vec<V> pull;  // 4 b₀ u
};

template <class V, class Rods>
struct MomentBlock : RowBlock<V, Rods> {
  Moment<V> moments[kPast];
};

/// Where a block has its moments: of the last step, of those before; the oldest makes room for the
/// step that begins. With now() = 2 the steps before are 1, 0, 4, 3 and, five ago, 2 itself.
class Ring {
 public:
  [[nodiscard]] int now() const { return now_; }
  /// That of so many steps ago, 1 to kPast.
  [[nodiscard]] int before(int steps) const { return kSlots[kPast + now_ - steps]; }
  void advance() { now_ = kSlots[now_ + 1]; }

 private:
  static constexpr int kSlots[2 * kPast] = {0, 1, 2, 3, 4, 0, 1, 2, 3, 4};
  int now_ = 0;
};

/// The same for the sweep of a step, whose ring does not turn.
struct Slots {
  int first, second, third, fourth, fifth;

  explicit Slots(const Ring& ring)
      : first(ring.before(1)),
        second(ring.before(2)),
        third(ring.before(3)),
        fourth(ring.before(4)),
        fifth(ring.now()) {}
};

/// Of a point: q_n, the predicted q' and a. Of that one at (0, −ℓ): (0, −ℓ), (ℓ, −ℓ) and (0, 0).
template <class V>
struct Predicted {
  Vec<V> from, to, pull;
};

/// Step 2. Differences first: additions have ports of their own.
template <class B, class V>
MBS_CHAIN_INLINE void predict(B& block, const Slots& at, Predicted<V>& point) {
  const Moment<V>& m1 = block.moments[at.first];
  const Moment<V>& m2 = block.moments[at.second];
  const Moment<V>& m3 = block.moments[at.third];
  const Moment<V>& m4 = block.moments[at.fourth];
  Moment<V>& m5 = block.moments[at.fifth];
  const V two = V{} + 2.0;
  const Vec<V> pull = m5.pull + (V{} + 5.0) * ((m1.pull - m4.pull) - two * (m2.pull - m3.pull));
  const Vec<V> pulls = (V{} + 0.5) * (pull + m4.pull) +
                       (V{} + kB1 / (2.0 * kB0)) * (m1.pull + m3.pull) +
                       (V{} + kB2 / (2.0 * kB0)) * m2.pull;
  const Vec<V> step =
      (m5.step + (V{} + 0.1) * ((m1.step - m4.step) - two * (m2.step - m3.step))) + pulls;
  point.from = block.x;
  point.to = block.x + step;
  point.pull = pull;
  block.x = point.to;
  m5.step = step;
  m5.pull = pull;
}

/// The acceleration that a step of the start begins with.
template <class Store>
void begin_start(Store& chain, const Ring& ring) {
  for (auto& block : chain.blocks) {
    block.moments[ring.now()].step = Vec<typename Store::V>{};
    block.moments[ring.now()].pull = (typename Store::V{} + 4.0 * kB0) * block.u;
  }
}
/// Adds (q' − q)/h of a stage to the step.
template <class Store>
void add_stage(Store& chain, const Ring& ring, double length) {
  for (auto& block : chain.blocks) {
    auto& step = block.moments[ring.now()].step;
    step = step + (typename Store::V{} + length) * block.w;
  }
}

/// v*, in the place of v.
template <class Store>
void set_velocity(Store& chain, const Ring& ring) {
  for (auto& block : chain.blocks) {
    Vec<typename Store::V> w = block.moments[ring.before(1)].step;
    for (int j = 0; j < kPast; ++j) {
      w = w + (typename Store::V{} + kVelocity[j] / (2.0 * kB0)) *
                  block.moments[ring.before(j + 1)].pull;
    }
    block.w = w;
  }
}

template <class Store>
class Multistep {
 public:
  using V = typename Store::V;
  using B = typename Store::B;
  using C = typename Store::C;
  using Residual = PositionResidual<Store>;

  /// Steps 1 and 2 and the first half of the first pass: R(q_n), q', w, a. The least pivot.
  MBS_CHAIN_INLINE static V begin(Store& chain, const Ring& ring) {
    const Slots at(ring);
    B* block = chain.blocks.data();
    const C* const* data = chain.constants.data();
    B* const end = block + chain.last;
    Carry<V> carry;
    V least = V{} + 1.0;
    Predicted<V> here;
    predict(*block, at, here);
    if (block != end) {
      Pending before;
      Predicted<V> next;
      predict(block[1], at, next);
      eliminate_block(*block, **data, here, next, least, carry, before);
      for (++block, ++data; block != end; ++block, ++data) {
        here = next;
        predict(block[1], at, next);
        Pending now;
        eliminate_block(*block, **data, here, next, least, carry, now);
        finish_block(block[-1], *data[-1], before, carry);
        before = now;
        before.f = carry.force + before.f;
      }
      finish_block(block[-1], *data[-1], before, carry);
      here = next;
    }
    Vec<V> f = Vec<V>{} - force(**data);
    const auto own = point(*block, **data, here, f);
    block->factors.scaled = Apart::meet<typename Store::Use>(own, carry, f, least, block->f);
    return least;
  }

  /// The first half of a later pass.
  MBS_CHAIN_INLINE static void inwards(Store& chain) { substitute_inwards(chain, Residual{}); }

  /// The second half of a pass: max|2 s Δq|.
  MBS_CHAIN_INLINE static V outwards(Store& chain, const Ring& ring) {
    LargestOf<typename Store::Use> largest;
    substitute_outwards(chain, [&, now = ring.now()](B& block, const Vec<V>& x) {
      const Vec<V> half = (V{} + 0.5) * x;
      Moment<V>& moment = block.moments[now];
      block.x = block.x - half;
      moment.step = moment.step - half;
      moment.pull = moment.pull - x;
      largest.add(x);
    });
    return largest.value();
  }

 private:
  MBS_CHAIN_INLINE static Vec<V> force(const C& data) { return (V{} + 4.0 * kB0) * data.force; }

  /// M + Σ d dᵀ of a point, and its right-hand side but for links.
  MBS_CHAIN_INLINE static auto point(B& block, const C& data, const Predicted<V>& here, Vec<V>& f) {
    f = f + data.mass.times(here.pull);
    for (int j = 0; j < Store::kRods; ++j) {
      const Vec<V> d = data.rods[j].vector(here.from);
      block.d[j] = d;
      f = f + data.rods[j].violation(data.rods[j].vector(here.to)) * d;
    }
    return Apart::own<Store::kRods>(data.mass, block.d);
  }

  /// An eliminated block whose factors are made when the next one's division has begun.
  struct Pending {
    Sym<V> S;
    Vec<V> z, e;
    V reciprocal;
    Vec<V> f;      // its right-hand side
    Vec<V> inner;  // what its link gives to the next one's
  };

  MBS_CHAIN_INLINE static void eliminate_block(B& block, const C& data, const Predicted<V>& here,
                                               const Predicted<V>& next, V& least, Carry<V>& carry,
                                               Pending& pending) {
    Vec<V> f = data.mass.outer(next.pull) - force(data);
    const auto own = point(block, data, here, f);
    pending.e = data.link.vector(next.from - here.from);
    block.e = pending.e;
    const V violation = data.link.violation(data.link.vector(next.to - here.to));
    const Vec<V> pull = violation * pending.e;
    pending.f = f - pull;
    pending.inner = pull + data.mass.inner(here.pull);
    Apart::eliminate(data.mass, own, pending.e, pending.S, pending.z, least, carry);
    pending.reciprocal = carry.reciprocal;
  }

  MBS_CHAIN_INLINE static void finish_block(B& block, const C& data, const Pending& pending,
                                            Carry<V>& carry) {
    Factors<V> factors;
    finish(factors, data.mass, pending.S, pending.z, pending.reciprocal, pending.e);
    block.f = pending.f;
    carry.force = forward(factors.gain, pending.inner, pending.f);
    block.factors.scaled = factors.scaled;
    for (int k = 0; k < 4; ++k) block.factors.gain[k] = factors.gain[k];
  }
};

}  // namespace mbs::compiled_chains
