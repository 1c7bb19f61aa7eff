// How models and states get into the blocks of a chain, and out of them.
#pragma once

#include <cstring>
#include <utility>

#include "chain_storage.hpp"

namespace mbs::compiled_ldl::chain {

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
auto Storage<Use, MassOf, Rods, BlockOf>::clear_lane(int block, int lane) -> void {
  const auto clear = [lane](auto& item) {
    auto* numbers = reinterpret_cast<V*>(&item);
    for (std::size_t k = 0; k < sizeof(item) / sizeof(V); ++k) numbers[k][lane] = 0.0;
  };
  clear(blocks[block]);
  clear(values_[block]);
  values_[block].mass.set(lane, {kImmovable, 0.0, kImmovable}, {});
}

template <class Use, template <class> class MassOf, class Rods,
          template <class, class> class BlockOf>
auto Storage<Use, MassOf, Rods, BlockOf>::clear(int chain) -> void {
  for (int k = 0; k <= last; ++k) {
    clear_lane(k, 2 * chain);
    clear_lane(k, 2 * chain + 1);
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
  to.x.x[lane] = units.length * (state.q[i] - from.here->origin[0]);
  to.x.y[lane] = units.length * (state.q[i + 1] - from.here->origin[1]);
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
auto Storage<Use, MassOf, Rods, BlockOf>::set(int chain, const Topology& topology,
                                              const Units& units, const State& state) -> void {
  clear(chain);
  for (int k = 0; k <= last; ++k) {
    for (const bool forward : {true, false}) {
      const Slot from = slot(k, forward, topology);
      if (!from.here) continue;
      const int lane = 2 * chain + (forward ? 0 : 1);
      set_constants(k, lane, from, units);
      set_state(k, lane, from, units, state);
    }
  }
  share();
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
  for (int k = 0; k <= last; ++k) {
    for (const bool forward : {true, false}) {
      const Slot to = slot(k, forward, topology);
      if (!to.here) continue;
      const int lane = 2 * chain + (forward ? 0 : 1);
      const B& from = blocks[k];
      const int i = to.here->coordinate;
      state.q[i] = to.here->origin[0] + from.x.x[lane] / units.length;
      state.q[i + 1] = to.here->origin[1] + from.x.y[lane] / units.length;
      state.v[i] = from.w.x[lane] / units.velocity;
      state.v[i + 1] = from.w.y[lane] / units.velocity;
      state.a[i] = from.u.x[lane] / units.acceleration;
      state.a[i + 1] = from.u.y[lane] / units.acceleration;
      const auto multiplier = [&](const Distance& distance, double value) {
        if (distance.row >= 0) state.lambda[distance.row] = value / units.multiplier;
      };
      for (int j = 0; j < kRods; ++j) multiplier(to.here->rods[j], from.rods[j][lane]);
      if (to.link) multiplier(*to.link, from.link[lane]);
    }
  }
}

}  // namespace mbs::compiled_ldl::chain
