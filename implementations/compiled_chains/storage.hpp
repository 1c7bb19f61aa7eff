// Chains in memory: what changes and what stays of each block, in the order of elimination.
#pragma once

#include <cmath>
#include <cstring>
#include <utility>
#include <vector>

#include "mass.hpp"
#include "mbs/simulation.hpp"
#include "topology.hpp"

namespace mbs::compiled_chains {

/// S = 2 I, so σ = 4, and O = −I: scaled = ½ I, gain = {−½, 0, 0, −½}.
template <class V>
struct Factors {
  Sym<V> scaled;  // S/σ: its adjugate is S⁻¹
  V gain[4];      // G = S⁻¹ O, by rows

  Factors() = default;
  Factors(const Factors&) = delete;  // see Vec
};

/// State and factors of a point, in the units of README.md. P of the example of Topology, at rest
/// at (5, −1), with 1 m in these units ℓ: x = (0, −ℓ), w = 0, rods[0] of A - P, link of P - Q.
template <class V, class Rods>
struct Block {
  Vec<V> x, u, w;       // position, acceleration, velocity
  V rods[Rods::kMost];  // multipliers
  V link;
  Vec<V> f;  // right-hand side between a sweep inwards and the one outwards
  Factors<V> factors;

  static constexpr auto kPosition = &Block::x;  // between steps
};

/// The vector difference of local coordinates + offset, whose square is to be `square`. It is zero
/// where there is none.
template <class V>
struct AnyLength {
  V there;  // all bits of a lane, or none
  Vec<V> offset;
  V square;

  void set(int lane, const Distance& from, double sign, double unit) {
    set_all_bits(there, lane);
    offset.x[lane] = sign * unit * from.offset[0];
    offset.y[lane] = sign * unit * from.offset[1];
    square[lane] = unit * unit * from.value;
  }
  MBS_CHAIN_INLINE Vec<V> vector(const Vec<V>& difference) const {
    return masked(read(there), difference + offset);
  }
  MBS_CHAIN_INLINE V violation(const Vec<V>& d) const { return d.x * d.x + (d.y * d.y - square); }
};

/// The distance to the fixed point that is the origin of the local coordinates.
template <class V>
struct OwnLength {
  V square;

  void set(int lane, const Distance& from, double /*sign*/, double unit) {
    square[lane] = unit * unit * from.value;
  }
  MBS_CHAIN_INLINE const Vec<V>& vector(const Vec<V>& x) const { return x; }
  MBS_CHAIN_INLINE V violation(const Vec<V>& d) const { return d.x * d.x + (d.y * d.y - square); }
};

/// Every point has one rod, a distance to a fixed point.
struct OneRod {
  static constexpr int kMost = 1;
  template <class V>
  using Length = OwnLength<V>;
};

template <int kMost_>
struct AtMostRods {
  static constexpr int kMost = kMost_;
  template <class V>
  using Length = AnyLength<V>;
};

/// P of the example of Topology: rods[0] and link are {all bits, (0, 0), ℓ²}, mass is {1, 0, 0},
/// force (0, −9.81) times Units::force. Of Q, the last block, both distances are zeros.
template <class V, class Mass, class Rods>
struct Constants {
  typename Rods::template Length<V> rods[Rods::kMost];
  AnyLength<V> link;  // inner − outer point
  Mass mass;
  Vec<V> force;
};

/// Factors between the model's units and those of the chain. With α = 10⁶, Δt = 10⁻³ and a coupling
/// of ¼ kg: mass 4, length 2, velocity 2 · 10⁻³, acceleration 10⁻⁶, multiplier and force 4 · 10⁻⁶.
struct Units {
  double mass, length, velocity, acceleration, multiplier, force;

  Units(const StepSettings& settings, const Topology& topology) {
    mass = topology.coupling > 0.0 ? 1.0 / topology.coupling : 1.0;
    length = std::sqrt(mass * settings.penalty) * settings.step;
    velocity = length * settings.step;
    acceleration = velocity * (0.5 * settings.step);
    multiplier = mass * settings.step * settings.step;
    force = mass * acceleration;
  }
};

/// The blocks of some chains of as many places, Lanes<Use>::kChains of them. Of one chain, as (lane
/// 0, lane 1): five places are the blocks (0, 4), (1, 3), (2, 2), four are (0, none), (1, 3), (2,
/// 2).
template <class Use_, template <class> class MassOf, class Rods_,
          template <class, class> class BlockOf = Block>
struct Storage {
  using Use = Use_;
  using V = typename Lanes<Use>::V;
  using Mass = MassOf<V>;
  using B = BlockOf<V, Rods_>;
  using C = Constants<V, Mass, Rods_>;
  static constexpr int kRods = Rods_::kMost;

  explicit Storage(int places)
      : places(places),
        last(places / 2),
        blocks(last + 1),
        constants(last + 1),
        values_(last + 1) {}
  Storage(const Storage&) = delete;  // constants point into it

  int places;
  int last;  // the block that is eliminated last, with the same in both lanes
  std::vector<B> blocks;
  std::vector<const C*> constants;  // of each block; blocks in a row share them where they can

  /// What a sweep has to do with, but for constants.
  [[nodiscard]] std::size_t bytes() const { return blocks.size() * sizeof(B); }

  /// Constants of a chain, at rest.
  void set_constants(int chain, const Topology& topology, const Units& units);
  /// All that a step begins with but for constants.
  void set_state(int chain, const Topology& topology, const Units& units, const State& state);
  void get(int chain, const Topology& topology, const Units& units, State& state) const;
  /// A chain at rest for ever, without forces and distances.
  void clear(int chain);

 private:
  void share();  // finds the constants that are equal

  /// What a lane of a block stands for. Of two ends the right one may have one block more than
  /// there are places: `here` is null.
  struct Slot {
    const Place* here;
    const Distance* link;  // to the place inwards; null at the last block
    const std::array<double, 4>* coupling;
    bool forward;  // whether inwards is the direction of the chain
  };
  [[nodiscard]] Slot slot(int block, bool forward, const Topology& topology) const;
  static void clear_lane(auto& item, int lane);
  void set_constants(int block, int lane, const Slot& from, const Units& units);
  void set_state(int block, int lane, const Slot& from, const Units& units, const State& state);

  std::vector<C> values_;
};

// How models and states get into the blocks of a chain, and out of them.

/// Mass of a point that stays at rest, whatever couples it to others.
inline constexpr double kImmovable = 1e50;

template <class Use, template <class> class MassOf, class Rods,
          template <class, class> class BlockOf>
auto Storage<Use, MassOf, Rods, BlockOf>::slot(int block, bool forward,
                                               const Topology& topology) const -> Slot {
  const int at = forward ? block : 2 * last - block;
  if (at >= places) return {nullptr, nullptr, nullptr, forward};
  const Place* here = &topology.places[at];
  if (block == last) return {here, nullptr, nullptr, forward};
  const Place* link = forward ? here : here - 1;
  return {here, &link->link, &link->coupling, forward};
}

template <class Use, template <class> class MassOf, class Rods,
          template <class, class> class BlockOf>
auto Storage<Use, MassOf, Rods, BlockOf>::clear_lane(auto& item, int lane) -> void {
  auto* numbers = reinterpret_cast<V*>(&item);
  for (std::size_t k = 0; k < sizeof(item) / sizeof(V); ++k) numbers[k][lane] = 0.0;
}

template <class Use, template <class> class MassOf, class Rods,
          template <class, class> class BlockOf>
auto Storage<Use, MassOf, Rods, BlockOf>::clear(int chain) -> void {
  for (int k = 0; k <= last; ++k) {
    for (const int lane : {2 * chain, 2 * chain + 1}) {
      clear_lane(blocks[k], lane);
      clear_lane(values_[k], lane);
      values_[k].mass.set(lane, {kImmovable, 0.0, kImmovable}, {});
    }
  }
  share();
}

template <class Use, template <class> class MassOf, class Rods,
          template <class, class> class BlockOf>
auto Storage<Use, MassOf, Rods, BlockOf>::set_constants(int block, int lane, const Slot& from,
                                                        const Units& units) -> void {
  C& to = values_[block];
  for (int j = 0; j < kRods; ++j) {
    const Distance& rod = from.here->rods[j];
    if (rod.row >= 0) to.rods[j].set(lane, rod, 1.0, units.length);
  }
  if (from.link && from.link->row >= 0) {
    to.link.set(lane, *from.link, from.forward ? 1.0 : -1.0, units.length);
  }
  std::array<double, 3> mass = from.here->mass;
  std::array<double, 4> coupling{};
  if (from.link) coupling = *from.coupling;
  if (!from.forward) std::swap(coupling[1], coupling[2]);
  for (double& entry : mass) entry *= units.mass;
  for (double& entry : coupling) entry *= units.mass;
  to.mass.set(lane, mass, coupling);
  to.force.x[lane] = units.force * from.here->force[0];
  to.force.y[lane] = units.force * from.here->force[1];
}

template <class Use, template <class> class MassOf, class Rods,
          template <class, class> class BlockOf>
auto Storage<Use, MassOf, Rods, BlockOf>::set_state(int block, int lane, const Slot& from,
                                                    const Units& units, const State& state)
    -> void {
  B& to = blocks[block];
  const int i = from.here->coordinate;
  (to.*B::kPosition).x[lane] = units.length * (state.q[i] - from.here->origin[0]);
  (to.*B::kPosition).y[lane] = units.length * (state.q[i + 1] - from.here->origin[1]);
  to.w.x[lane] = units.velocity * state.v[i];
  to.w.y[lane] = units.velocity * state.v[i + 1];
  to.u.x[lane] = units.acceleration * state.a[i];
  to.u.y[lane] = units.acceleration * state.a[i + 1];
  const auto multiplier = [&](const Distance& distance) {
    return distance.row < 0 ? 0.0 : units.multiplier * state.lambda[distance.row];
  };
  for (int j = 0; j < kRods; ++j) to.rods[j][lane] = multiplier(from.here->rods[j]);
  if (from.link) to.link[lane] = multiplier(*from.link);
}

template <class Use, template <class> class MassOf, class Rods,
          template <class, class> class BlockOf>
auto Storage<Use, MassOf, Rods, BlockOf>::set_constants(int chain, const Topology& topology,
                                                        const Units& units) -> void {
  clear(chain);
  for (int k = 0; k <= last; ++k) {
    for (const bool forward : {true, false}) {
      const Slot from = slot(k, forward, topology);
      if (from.here) set_constants(k, 2 * chain + (forward ? 0 : 1), from, units);
    }
  }
  share();
}

template <class Use, template <class> class MassOf, class Rods,
          template <class, class> class BlockOf>
auto Storage<Use, MassOf, Rods, BlockOf>::set_state(int chain, const Topology& topology,
                                                    const Units& units, const State& state)
    -> void {
  for (int k = 0; k <= last; ++k) {
    for (const bool forward : {true, false}) {
      const Slot from = slot(k, forward, topology);
      const int lane = 2 * chain + (forward ? 0 : 1);
      clear_lane(blocks[k], lane);  // what is not finite would go on
      if (from.here) set_state(k, lane, from, units, state);
    }
  }
}

template <class Use, template <class> class MassOf, class Rods,
          template <class, class> class BlockOf>
auto Storage<Use, MassOf, Rods, BlockOf>::share() -> void {
  for (int k = 0; k <= last; ++k) {
    const C& own = values_[k];
    const bool same = k > 0 && std::memcmp(constants[k - 1], &own, sizeof(C)) == 0;
    constants[k] = same ? constants[k - 1] : &own;
  }
}

template <class Use, template <class> class MassOf, class Rods,
          template <class, class> class BlockOf>
auto Storage<Use, MassOf, Rods, BlockOf>::get(int chain, const Topology& topology,
                                              const Units& units, State& state) const -> void {
  const double length = 1.0 / units.length, velocity = 1.0 / units.velocity;
  const double acceleration = 1.0 / units.acceleration, factor = 1.0 / units.multiplier;
  for (int k = 0; k <= last; ++k) {
    const B& from = blocks[k];  // scaled in all lanes at once, which takes as long as in one
    const Vec<V>& x = from.*B::kPosition;
    const V q[2] = {length * x.x, length * x.y};
    const V v[2] = {velocity * from.w.x, velocity * from.w.y};
    const V a[2] = {acceleration * from.u.x, acceleration * from.u.y};
    V rods[kRods];
    for (int j = 0; j < kRods; ++j) rods[j] = factor * from.rods[j];
    const V link = factor * from.link;
    for (const bool forward : {true, false}) {
      const Slot to = slot(k, forward, topology);
      if (!to.here) continue;
      const int lane = 2 * chain + (forward ? 0 : 1);
      for (int axis = 0; axis < 2; ++axis) {
        const int i = to.here->coordinate + axis;
        state.q[i] = to.here->origin[axis] + q[axis][lane];
        state.v[i] = v[axis][lane];
        state.a[i] = a[axis][lane];
      }
      const auto multiplier = [&](const Distance& distance, double value) {
        if (distance.row >= 0) state.lambda[distance.row] = value;
      };
      for (int j = 0; j < kRods; ++j) multiplier(to.here->rods[j], rods[j][lane]);
      if (to.link) multiplier(*to.link, link[lane]);
    }
  }
}

}  // namespace mbs::compiled_chains
