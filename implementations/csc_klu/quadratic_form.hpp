// A dot or bilinear constraint in the common form u . B w, for those who need B.
#pragma once

#include <array>
#include <span>

#include "jacobian_pattern.hpp"
#include "mbs/model.hpp"
#include "point_vector.hpp"

namespace mbs::csc_klu {

/// Phi = (r_a - r_b) . B (r_c - r_d) - s; a dot constraint has the identity for B.
template <int dim>
struct QuadraticForm {
  std::array<int, 4> abcd;  ///< indices into Model::points()
  SmallMatrix<dim> B;
};

/// The quadratic constraint at position `row` of the model.
template <int dim>
QuadraticForm<dim> quadratic_form(const Model& model, int row) {
  const std::span<const DotConstraint> dots = model.dot_constraints();
  if (row < std::ssize(dots)) {
    const DotConstraint& dot = dots[row];
    SmallMatrix<dim> identity{};
    for (int k = 0; k < dim; ++k) identity[k][k] = 1.0;
    return {{dot.a, dot.b, dot.c, dot.d}, identity};
  }
  const BilinearConstraint& bilinear = model.bilinear_constraints()[row - std::ssize(dots)];
  return {{bilinear.a, bilinear.b, bilinear.c, bilinear.d}, small_matrix<dim>(bilinear.B)};
}

}  // namespace mbs::csc_klu
