// Springs and dampers between two points: their forces, and their share of C and K.
#pragma once

#include <armadillo>
#include <array>
#include <vector>

#include "layout.hpp"
#include "mbs/model.hpp"
#include "mbs/simulation.hpp"

namespace mbs::armadillo_dense {

/// Each spring keeps, from the last evaluate(), what its part of h K + (Δt/2) C is made from: the
/// 2 x 2 blocks ±S with S = axial e eᵀ + transverse I, of which only free ends have any.
class Springs {
 public:
  Springs(const Model& model, const Layout& layout, const StepSettings& settings);

  [[nodiscard]] bool empty() const { return springs_.empty(); }

  /// rhs (n) += h Q at extended positions x and velocities v.
  template <int dimension>
  void evaluate(const double* x, const double* v, double* rhs);
  /// T (n x n in columns of `height`; its lower triangle counts) += h K + (Δt/2) C of the last
  /// evaluate().
  template <int dimension>
  void add_to(double* T, arma::uword height) const;

 private:
  struct Element {
    int a, b;                    ///< of the points, in extended vectors
    int count;                   ///< of the free ends, 1 or 2
    std::array<int, 2> ends;     ///< starts of the free ends, ascending
    std::array<double, 2> sign;  ///< 1 at a, -1 at b
    double stiffness, damping, length;
    double weight;            ///< (Δt/2) damping + h stiffness
    std::array<double, 3> e;  ///< from b to a, unit length
    double axial, transverse;
  };

  double h_;  ///< Δt²/4, s²
  std::vector<Element> springs_;
};

}  // namespace mbs::armadillo_dense
