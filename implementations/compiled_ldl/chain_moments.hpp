// What the symmetric multistep method, Eq. (17), keeps of earlier steps, and makes of it.
#pragma once

#include <array>

#include "chain_rows.hpp"

namespace mbs::compiled_ldl::chain {

/// So many steps and accelerations make the next step.
inline constexpr int kPast = 5;

/// Coefficients of Eq. (17). c is 1/10 (1, −2, 2, −1, 10), b is b₀ (1, …, 1) where not given.
inline constexpr double kB0 = 3331.0 / 2400.0;
inline constexpr double kB1 = -73.0 / 300.0;  // and b₃
inline constexpr double kB2 = 3133.0 / 1200.0;
inline constexpr std::array<double, kPast> kVelocity = {475.0 / 288.0, -247.0 / 90.0, 631.0 / 240.0,
                                                        -58.0 / 45.0, 367.0 / 1440.0};

/// A step and the acceleration that it began with: what half a pass's x and a whole one is taken
/// from.
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
/// step that begins.
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

/// Of a point: q_n, the predicted q' and a.
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

}  // namespace mbs::compiled_ldl::chain
