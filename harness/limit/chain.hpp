// The paper's step for the N-four-bar by hand, templated over the number that fills both lanes.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "limit/storage.hpp"
#include "mbs/simulation.hpp"

namespace mbs::limit {

/// The chain of N + 1 blocks, eliminated from both ends towards the middle block. README.md has the
/// units and the derivation.
template <class V>
class Chain {
 public:
  /// Scheme, projections and the like as by default; others are not looked at.
  Chain(int loops, const StepSettings& settings);

  void set_state(const State& state);
  void get_state(State& state) const;
  StepOutcome step();

  [[nodiscard]] std::span<const Block<V>> blocks() const { return blocks_; }

 private:
  template <bool kFirst>
  void pass();
  template <bool kFirst, bool kPadded>
  void sweep();
  template <bool kFirst>
  Own<V> take(Block<V>& block) const;
  template <bool kFirst>
  V tension(const V& violation, V& multiplier) const;
  template <bool kFirst, bool kPadded>
  Evaluated<V> evaluate(std::size_t i, const Place<V>& place, Own<V>& own);
  template <bool kPadded>
  Pivot<V> pivot(const Evaluated<V>& at, const Eliminated<V>& last) const;
  template <bool kFirst>
  void solve_middle(const Own<V>& own, const Eliminated<V>& last, Factor<V>& outer);
  bool substitute_back();
  template <class Side>
  void project();

  /// N + 1 is even: the right lane starts with a block that is not there.
  [[nodiscard]] bool padded() const { return loops_ % 2 != 0; }
  /// Where B_j is, and which lane of it.
  struct Seat {
    std::size_t block;
    int lane;
  };
  [[nodiscard]] Seat seat(int j) const;
  void set_constants(double weight);
  void set(V Block<V>::*field, Seat seat, double value);

  int loops_;
  int max_passes_;
  std::size_t depth_;         // blocks before the middle one
  double s_, h_, tolerance_;  // m^-1 of README.md's units; s; of 2 s Delta q
  ChainConstants<V> constants_;
  Place<V> first_, second_, interior_, middle_;
  std::vector<Block<V>> blocks_;    // depth_ + 1, the middle one in both lanes
  std::vector<Factor<V>> factors_;  // likewise
};

extern template class Chain<Pair>;

}  // namespace mbs::limit
