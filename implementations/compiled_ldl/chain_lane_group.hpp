// As many chains as a register has room for, and what a step tells of each.
#pragma once

#include "chain_storage.hpp"

namespace mbs::compiled_ldl::chain {

using WideMask = Lanes<Wide>::Mask;

/// The chains for which a comparison holds in both lanes.
template <class Comparison>
WideMask where(const Comparison& comparison) {
  const auto lanes = (WideMask)comparison;
  return lanes & Lanes<Wide>::other_end(lanes);
}

inline bool any(const WideMask& mask) {
#if defined(__AVX512F__)
  return _mm512_test_epi64_mask((__m512i)mask, (__m512i)mask) != 0;
#endif
  long long bits = 0;
  for (int lane = 0; lane < kRegisterDoubles; ++lane) bits |= mask[lane];
  return bits != 0;
}

/// What the batches of all schemes have in common. A lane without a chain is at rest.
template <class Store>
class LaneGroup {
 public:
  static constexpr int kChains = Lanes<Wide>::kChains;

  LaneGroup(int places, const StepSettings& settings) : settings_(settings), chain_(places) {
    for (int chain = 0; chain < kChains; ++chain) clear(chain);
  }
  [[nodiscard]] std::size_t bytes() const { return chain_.bytes(); }

  void set_state(int chain, const Topology& topology, const StepSettings& settings,
                 const State& state) {
    const Units units(settings, topology);
    chain_.set(chain, topology, units, state);
    mark(chain, 2.0 * units.length * settings.tolerance, -1);
    steps_ = 0;
  }
  void clear(int chain) {
    chain_.clear(chain);
    mark(chain, 1.0, 0);
  }

  [[nodiscard]] StepOutcome outcome(int chain) const {
    const int lane = 2 * chain;
    const StepStatus status = failed_[lane]  ? StepStatus::factorization_failed
                              : limit_[lane] ? StepStatus::pass_limit
                                             : StepStatus::converged;
    return {status, static_cast<int>(-passes_[lane]), factorizations_};
  }

 protected:
  using V = typename Store::V;

  StepSettings settings_;
  mutable Store chain_;  // RATTLE completes λ when somebody asks for it
  V tolerance_{};        // of |2 s Δq|
  WideMask running_{};   // which chains there are
  long steps_ = 0;       // since the state was set

  // of the present step
  WideMask passes_{};  // the negative of their number
  WideMask failed_{};  // which chains have no factors
  WideMask limit_{};   // which stopped at the limit
  int factorizations_ = -1;

 private:
  void mark(int chain, double tolerance, long long running) {
    for (int lane = 2 * chain; lane < 2 * chain + 2; ++lane) {
      tolerance_[lane] = tolerance;
      running_[lane] = running;
    }
  }
};

}  // namespace mbs::compiled_ldl::chain
