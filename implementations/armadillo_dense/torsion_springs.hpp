// Springs and dampers on an angle between two directions: their forces, and their share of C and K.
#pragma once

#include <armadillo>
#include <array>
#include <vector>

#include "layout.hpp"
#include "mbs/model.hpp"
#include "mbs/simulation.hpp"

namespace mbs::armadillo_dense {

/// Each element keeps, from the last evaluate(), the entries of its gradient g at free points; its
/// part of h K + (Δt/2) C is weight g gᵀ.
class TorsionSprings {
 public:
  TorsionSprings(const Model& model, const Layout& layout, const StepSettings& settings);

  [[nodiscard]] bool empty() const { return springs_.empty(); }

  /// rhs (n) += h Q at extended positions x and velocities v.
  template <int dimension>
  void evaluate(const double* x, const double* v, double* rhs);
  /// T (n x n in columns of `height`; its lower triangle counts) += h K + (Δt/2) C of the last
  /// evaluate().
  template <int dimension>
  void add_to(double* T, arma::uword height) const;

 private:
  /// A free point and its entries of g: w_cd (z x w)/(w.w) + w_ab (-(z x u)/(u.u)).
  struct End {
    int start;
    double w_cd, w_ab;  ///< roles of one point are added up
    std::array<double, 3> g;
  };
  struct Element {
    int a, b, c, d;  ///< of the points, in extended vectors
    int axis;        ///< of z in extended vectors; planar: unused
    int count;       ///< of the free points, 1 to 4
    std::array<End, 4> ends;
    double stiffness, damping, angle;
    double weight;  ///< (Δt/2) damping + h stiffness
  };

  [[nodiscard]] Element lower(const TorsionSpring& spring, const Layout& layout) const;

  double half_step_;  ///< Δt/2, s
  double h_;          ///< Δt²/4, s²
  std::vector<Element> springs_;
};

}  // namespace mbs::armadillo_dense
