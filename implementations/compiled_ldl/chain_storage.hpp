// Chains in memory: what changes and what stays of each block, in the order of elimination.
#pragma once

#include <cmath>
#include <vector>

#include "chain_mass.hpp"
#include "chain_topology.hpp"
#include "mbs/simulation.hpp"

namespace mbs::compiled_ldl::chain {

template <class V>
struct Factors {
  Sym<V> scaled;  // S/σ: its adjugate is S⁻¹
  V gain[4];      // G = S⁻¹ O, by rows

  Factors() = default;
  Factors(const Factors&) = delete;  // see Vec
};

/// State and factors of a point, in the units of chain.md.
template <class V, class Rods>
struct Block {
  Vec<V> x, u, w;       // position, acceleration, velocity
  V rods[Rods::kMost];  // multipliers
  V link;
  Vec<V> f;  // right-hand side between a sweep inwards and the one outwards
  Factors<V> factors;
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

template <class V, class Mass, class Rods>
struct Constants {
  typename Rods::template Length<V> rods[Rods::kMost];
  AnyLength<V> link;  // inner − outer point
  Mass mass;
  Vec<V> force;
};

/// Factors between the model's units and those of the chain.
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

/// The blocks of some chains of as many places, Lanes<Use>::kChains of them.
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

  /// Constants and state of a chain.
  void set(int chain, const Topology& topology, const Units& units, const State& state);
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
  void clear_lane(int block, int lane);
  void set_constants(int block, int lane, const Slot& from, const Units& units);
  void set_state(int block, int lane, const Slot& from, const Units& units, const State& state);

  std::vector<C> values_;
};

}  // namespace mbs::compiled_ldl::chain

#include "chain_storage_fill.hpp"  // IWYU pragma: keep
