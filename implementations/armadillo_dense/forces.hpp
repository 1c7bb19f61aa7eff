// Forces that depend on the motion: springs, torsion springs and couples.
#pragma once

#include <armadillo>
#include <vector>

#include "layout.hpp"
#include "mbs/model.hpp"
#include "mbs/simulation.hpp"
#include "springs.hpp"
#include "torsion_springs.hpp"

namespace mbs::armadillo_dense {

/// All terms of Eq. (11). C and K are not stored: what elements keep from the last evaluate() is
/// added to T element by element.
class Forces {
 public:
  Forces(const Model& model, const Layout& layout, const StepSettings& settings);

  [[nodiscard]] bool empty() const { return couples_.empty() && !stiffen(); }
  /// Whether anything but couples is there, which are neither in C nor in K.
  [[nodiscard]] bool stiffen() const { return !springs_.empty() || !torsion_springs_.empty(); }

  /// rhs (n) += h Q at extended positions x and velocities v.
  void evaluate(const arma::vec& x, const arma::vec& v, arma::vec& rhs);
  /// T (n x n in columns of `height`; its lower triangle counts) += h K + (Δt/2) C of the last
  /// evaluate().
  void add_to(double* T, arma::uword height) const;

 private:
  struct CoupleEnd {
    int end, other;  ///< in extended vectors; the free point acted on, and where w comes from
    int axis;        ///< of z in extended vectors; planar: unused
    double torque;   ///< N m, times h
  };

  template <int dimension>
  void evaluate_couples(const double* x, double* rhs) const;

  const Layout& layout_;
  Springs springs_;
  TorsionSprings torsion_springs_;
  std::vector<CoupleEnd> couples_;
};

}  // namespace mbs::armadillo_dense
