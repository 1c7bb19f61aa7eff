// Applied forces, Eq. (11): springs, torsion springs, couples; what they add to C and K.
#pragma once

#include "scene.hpp"

namespace mbs::compiled_ldl {

template <typename S, int D>
class Forces {
 public:
  Forces(std::span<const Model* const> models, const Program& program, const Rows& rows,
         double step);

  [[nodiscard]] bool any() const { return has_stiffness() || !couples_.empty(); }
  [[nodiscard]] bool has_stiffness() const { return springs_.count() > 0 || !torsions_.empty(); }

  /// y += factor times Q of (q, v), without its constant part.
  void add(const S* q, const S* v, const S& factor, S* y);
  /// Keeps C and K of the last add() for what follows.
  void keep();
  void keep_where(const LaneMask& mask) {
    copy_where(mask, direction_, kept_);
    copy_where(mask, across_, kept_across_);
    copy_where(mask, torsion_directions_, kept_torsions_);
  }
  /// += (Δt/2) C + (Δt²/4) K.
  template <typename F>
  void add_matrix(F* matrix) const;
  /// y += ((Δt/2) C + (Δt²/4) K) x.
  void add_product(const S* x, S* y) const;

 private:
  struct Element {
    S stiffness, damping, free;  // free length or angle
  };
  struct Couple2 {
    int a, b, axis;
    S torque;
  };
  void add_spring(const S* q, const S* v, const S& factor, S* y, int k);
  void add_torsion(const S* q, const S* v, const S& factor, S* y, int k);
  void add_couple(const S* q, const S& factor, S* y, const Couple2& couple) const;
  /// y = z × x; planar z is (0, 0, 1).
  static void turn(const S* z, const S* x, S* y);

  Pairs springs_;
  std::vector<Quad> torsions_;
  std::vector<int> torsion_axes_;  // rows
  std::vector<Place> places_;
  std::vector<Couple2> couples_;
  Array<Element> spring_, torsion_;
  Array<S> direction_,
      torsion_directions_;  // gradients: e of a spring, A and C of a torsion spring
  Array<S> across_;         // p of a spring
  Array<S> kept_, kept_torsions_, kept_across_;
  Array<S> weight_, torsion_weight_;  // (Δt/2) c + (Δt²/4) k
  S h_;                               // Δt²/4
};

}  // namespace mbs::compiled_ldl

#include "forces_evaluate.hpp"
#include "forces_setup.hpp"
