// Splits the time of a step over its phases; one predictable branch a mark while it is off.
#pragma once

#include <array>
#include <cstdint>

namespace mbs {

/// What a step spends its time on. Equations as numbered in paper/README.md.
enum class Phase {
  evaluation,     ///< Phi, Phi_q and the residual, Eq. (3)
  assembly,       ///< values of the tangent matrix, Eq. (5)
  factorization,  ///< factorization of the tangent matrix
  solve,          ///< back-substitutions of Eqs. (4) and (6)
  projection,     ///< right-hand sides of Eq. (6)
  other,          ///< predictor, updates of Eq. (2) and of lambda*, convergence test
};
inline constexpr int kPhaseCount = 6;

/// An implementation calls enter() wherever its step changes phase; the time up to the next enter()
/// is booked on that phase. The harness owns the clock: it starts, stops and reads it.
///
///   phases_.enter(Phase::evaluation);     // evaluate Phi, Phi_q, f
///   phases_.enter(Phase::factorization);  // books the above on `evaluation`
///
/// The clock starts in Phase::other, before the first step of many, and the phase that ends a step
/// lasts until the next one enters its own: begin a step with enter(Phase::other).
///
/// Ticks are those of the processor's time stamp counter where there is one, else nanoseconds; only
/// shares of the total are meaningful.
class PhaseClock {
 public:
  void enter(Phase phase) noexcept {
    if (running_) book(phase);
  }

  void start() noexcept {
    ticks_.fill(0);
    current_ = Phase::other;
    running_ = true;
    last_ = now();
  }
  void stop() noexcept {
    if (running_) book(Phase::other);
    running_ = false;
  }
  /// Ticks booked on each phase since start(), indexed by Phase.
  [[nodiscard]] const std::array<std::uint64_t, kPhaseCount>& ticks() const { return ticks_; }

 private:
  static std::uint64_t now() noexcept;
  void book(Phase next) noexcept;

  bool running_ = false;
  Phase current_ = Phase::other;
  std::uint64_t last_ = 0;
  std::array<std::uint64_t, kPhaseCount> ticks_{};
};

}  // namespace mbs
