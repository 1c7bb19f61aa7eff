// Where everything in Phi and Phi_q is stored, found once from the model.
#pragma once

#include <vector>

#include "extended_points.hpp"
#include "mbs/model.hpp"
#include "point_vector.hpp"

namespace mbs::csc_klu {

/// Where everything in Phi and Phi_q is, with all searching done. Constraints are reordered:
/// distances, other dot constraints, bilinear, linear ones. Points are found in extended vectors.
///
/// Phi_q of the quadratic (all but linear) constraints is stored by columns: a free point owns
/// `dim` columns, and its blocks (one constraint's `dim` values) are consecutive. Constraints are
/// evaluated one by one, and their values written to recorded blocks. Example, planar, distances
/// A-B (A fixed) and B-C: B owns blocks 0 and 1 (rows 0, 1), C owns block 2 (row 1); 3 is a spare
/// for what A would get.
template <int dim>
struct JacobianPattern {
  struct Distance {
    int a, b;              ///< offsets into the extended vector
    int block_a, block_b;  ///< where its values go, the spare block for a fixed point
    double value;          ///< m^2; zero here and below where it is a function of time
  };
  struct Dot {
    int a, b, c, d;  ///< offsets into the extended vector
    double value;    ///< m^2
    int terms_end;   ///< its terms end here and begin where those before end
  };
  struct Bilinear {
    int a, b, c, d;  ///< as in Dot, as are the others
    double value;
    int terms_end;
    SmallMatrix<dim> B;
  };
  /// The block of one free point: first B (r_c - r_d) + second B^T (r_a - r_b), Eq. (7).
  struct Term {
    int block;
    double first, second;  ///< those of MovedPoint
  };
  struct Linear {
    double value;   ///< m
    int terms_end;  ///< as in Dot
  };

  explicit JacobianPattern(const Model& model);
  [[nodiscard]] int quadratics() const {
    return static_cast<int>(distances.size() + dots.size() + bilinears.size());
  }
  [[nodiscard]] int blocks() const { return static_cast<int>(block_row.size()); }
  [[nodiscard]] int points() const { return static_cast<int>(block_begin.size()) - 1; }

  std::vector<int> model_row;    ///< m; position in the model of each constraint here
  std::vector<int> block_begin;  ///< free points + 1; point p owns q[dim p .. dim p + dim)
  std::vector<int> block_row;    ///< constraint of each block
  std::vector<Distance> distances;
  std::vector<Dot> dots;
  std::vector<Bilinear> bilinears;
  std::vector<Term> terms;  ///< of dots and bilinears
  std::vector<Linear> linears;
  std::vector<LinearConstraint::Term> linear_terms;
};

/// The upper left dim x dim part of a matrix of the model.
template <int dim>
SmallMatrix<dim> small_matrix(const std::array<std::array<double, 3>, 3>& B) {
  SmallMatrix<dim> part;
  for (int row = 0; row < dim; ++row) {
    for (int col = 0; col < dim; ++col) part[row][col] = B[row][col];
  }
  return part;
}

}  // namespace mbs::csc_klu
