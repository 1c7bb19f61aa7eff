// One stage of RATTLE on a chain, Eq. (14): its sweeps, with the multipliers eliminated.
#pragma once

#include <cmath>
#include <span>

#include "rows.hpp"

namespace mbs::compiled_chains {

/// Lengths of a step's stages, in steps (paper/README.md, "RATTLE"); of the first steps of the
/// multistep method too.
inline std::span<const double> stage_lengths(Scheme scheme) {
  static constexpr double kOnce[] = {1.0};
  static const double g = 1.0 / (4.0 - std::cbrt(4.0));
  static const double kFourth[] = {g, g, 1.0 - 4.0 * g, g, g};
  static constexpr double w1 = -1.17767998417887100694641568096431573;
  static constexpr double w2 = 0.235573213359358133684793182978534602;
  static constexpr double w3 = 0.784513610477557263819497633866349876;
  static constexpr double w0 = 1.0 - 2.0 * (w1 + w2 + w3);
  static constexpr double kSixth[] = {w3, w2, w1, w0, w1, w2, w3};
  if (scheme == Scheme::rattle4) return kFourth;
  if (scheme == Scheme::rattle6 || scheme == Scheme::multistep6) return kSixth;
  return kOnce;
}

/// Of a velocity or an acceleration.
inline constexpr int kMostRefinements = 5;

/// With `kMasked` refinements and further passes are for the lanes `active` only.
template <class Store, bool kMasked = false, class Elimination = Together>
class RattleStage {
 public:
  using V = typename Store::V;
  using B = typename Store::B;
  using C = typename Store::C;
  using Mask = typename Lanes<typename Store::Use>::Mask;

  /// Steps 1 and 2: the first pass of a stage of `length` steps predicts. Returns max|2 s Δq|.
  /// (q' − q)/h takes the place of v; it is summed up, not made from q', so that it keeps its
  /// digits.
  template <bool kFirst>
  static V pass(Store& chain, double length, const Mask& active = Mask()) {
    const Position<kFirst> terms(V{} + length);
    const V inverse_length = V{} + 1.0 / length;
    if (kFirst) terms.predict(chain.blocks[0]);
    substitute_inwards(chain, terms);
    LargestOf<typename Store::Use> largest;
    substitute_outwards(chain, [&](B& block, const Vec<V>& x) {
      const Vec<V> half = (V{} + 0.5) * x;
      set<kMasked>(block.x, block.x - half, active);
      set<kMasked>(block.w, block.w - inverse_length * half, active);
      largest.add(x);
    });
    return largest.value();
  }

  /// Steps 3 and 4: R(q') and the velocity. Returns the least pivot.
  template <bool kVelocity>
  static V factorize(Store& chain, double length) {
    const V least = factorize_inwards<kVelocity>(chain, V{} + length);
    if (kVelocity) {
      substitute_outwards(chain, [](B& block, const Vec<V>& x) { block.w = block.w + x; });
    }
    return least;
  }

  /// Step 4, one refinement: max|s Δt δ|.
  static V refine_velocity(Store& chain, const Mask& active = Mask()) {
    substitute_inwards(chain, VelocityTerms{});
    LargestOf<typename Store::Use> largest;
    substitute_outwards(chain, [&](B& block, const Vec<V>& x) {
      set<kMasked>(block.w, block.w + x, active);
      largest.add(x);
    });
    return largest.value();
  }

  /// Step 5.
  static void acceleration(Store& chain) {
    substitute_inwards(chain, Acceleration{});
    substitute_outwards(chain, [](B& block, const Vec<V>& x) { block.u = x; });
  }

  /// Step 5, one refinement: max|s Δt²/2 δ|. Its λ is that of the solution before: settle() adds
  /// what the last one brings.
  template <bool kFirst>
  static V refine_acceleration(Store& chain, const Mask& active = Mask()) {
    acceleration_residual(chain, [&](V& multiplier, const V& rate) {
      // ε⁻¹ times a residual is part of λ
      set<kMasked>(multiplier, kFirst ? rate : V(multiplier + rate), active);
    });
    LargestOf<typename Store::Use> largest;
    substitute_outwards(chain, [&](B& block, const Vec<V>& x) {
      set<kMasked>(block.u, block.u + x, active);
      largest.add(x);
    });
    return largest.value();
  }

  static void settle(Store& chain) {
    for (int k = 0; k <= chain.last; ++k) {
      B& block = chain.blocks[k];
      for (int j = 0; j < Store::kRods; ++j) block.rods[j] += rod_rate(block, j);
      if (k < chain.last) block.link += link_rate(block, chain.blocks[k + 1]);
    }
  }

 private:
  template <bool kFirst>
  struct Position : PositionResidual<Store> {
    V length;

    explicit Position(const V& length) : length(length) {}
    MBS_CHAIN_INLINE void predict(B& block) const {
      block.w = block.w + length * block.u;
      block.x = block.x + length * block.w;
    }
    MBS_CHAIN_INLINE void link(const B& block, B& next, const C& data, Vec<V>& f,
                               Vec<V>& inner) const {
      if (kFirst) predict(next);
      PositionResidual<Store>::link(block, next, data, f, inner);
    }
  };

  struct Velocity {
    MBS_CHAIN_INLINE const Vec<V>& operator()(const B& block) const { return block.w; }
  };
  using VelocityTerms = VelocityResidual<Store, Velocity>;

  /// Q − ε⁻¹ Φqᵀ Φ̇q v
  struct Acceleration {
    MBS_CHAIN_INLINE Vec<V> point(const B& block, const C& data) const {
      Vec<V> f = data.force;
      const V half_square = (V{} + 0.5) * dot(block.w, block.w);
      for (int j = 0; j < Store::kRods; ++j) f = f - half_square * block.d[j];
      return f;
    }
    MBS_CHAIN_INLINE void link(const B& block, const B& next, const C&, Vec<V>& f,
                               Vec<V>& inner) const {
      const Vec<V> rate = next.w - block.w;
      pull_together((V{} + 0.5) * dot(rate, rate), block.e, f, inner);
    }
  };

  /// Evaluates and keeps the rows of Φq of a point; M + Σ d dᵀ.
  MBS_CHAIN_INLINE static auto rows(B& block, const C& data) {
    for (int j = 0; j < Store::kRods; ++j) block.d[j] = data.rods[j].vector(block.x);
    return Elimination::template own<Store::kRods>(data.mass, block.d);
  }

  /// With `kVelocity` also substitutes inwards for what v' is more than (q' − q)/h: it is small, so
  /// that what M has lost in T hardly matters.
  template <bool kVelocity>
  static V factorize_inwards(Store& chain, const V& length) {
    B* block = chain.blocks.data();
    const C* const* data = chain.constants.data();
    B* const end = block + chain.last;
    Carry<V> carry;
    V least = V{} + 1.0;
    const VelocityTerms terms{};
    for (; block != end; ++block, ++data) {
      const auto own = rows(*block, **data);
      const Vec<V> e = (*data)->link.vector(block[1].x - block->x);
      block->e = e;
      Sym<V> S;
      Vec<V> z;
      const V reciprocal = Elimination::eliminate((*data)->mass, own, e, S, z, least, carry);
      finish(block->factors, (*data)->mass, S, z, reciprocal, e);
      if (!kVelocity) continue;
      Vec<V> f = length * (*data)->force + terms.point(*block, **data);
      Vec<V> inner;
      terms.link(*block, block[1], **data, f, inner);
      f = carry.force + f;
      block->f = f;
      carry.force = forward(block->factors.gain, inner, f);
    }
    const auto own = rows(*block, **data);
    const Vec<V> f = length * (*data)->force + terms.point(*block, **data);
    block->factors.scaled =
        Elimination::template meet<typename Store::Use>(own, carry, f, least, block->f);
    return least;
  }
};

}  // namespace mbs::compiled_chains
