// Where everything in Phi and Phi_q is stored, found once from the model.
#pragma once

#include <vector>

#include "mbs/model.hpp"

namespace mbs::csc_klu {

/// Where everything in Phi and Phi_q is, with all searching done. Constraints are reordered:
/// distances, other dot constraints, linear ones. Points live in an extended vector, the n
/// coordinates of q followed by those of the fixed points, so that no loop asks which are fixed.
///
/// Phi_q of the dot constraints is stored by columns: a free point owns `dim` columns, and its
/// blocks (one constraint's `dim` values) are consecutive. Constraints are evaluated one by one,
/// and their values written to recorded blocks. Example, planar, distances A-B (A fixed) and B-C:
/// B owns blocks 0 and 1 (rows 0, 1), C owns block 2 (row 1); 3 is a spare for what A would get.
template <int dim>
struct JacobianPattern {
  struct Distance {
    int a, b;              ///< offsets into the extended vector
    int block_a, block_b;  ///< where its values go, the spare block for a fixed point
    double value;          ///< m^2
  };
  struct Dot {
    int a, b, c, d;  ///< offsets into the extended vector
    double value;    ///< m^2
    int terms_end;   ///< its terms end here and begin where those before end
  };
  /// The block of one free point of a Dot: first (r_c - r_d) + second (r_a - r_b), Eq. (7).
  struct Term {
    int block;
    double first, second;  ///< from -2 to 2: signs, added up where points coincide
  };
  struct Linear {
    double value;   ///< m
    int terms_end;  ///< as in Dot
  };

  explicit JacobianPattern(const Model& model);
  [[nodiscard]] int dots() const { return static_cast<int>(distances.size() + others.size()); }
  [[nodiscard]] int blocks() const { return static_cast<int>(block_row.size()); }
  [[nodiscard]] int points() const { return static_cast<int>(block_begin.size()) - 1; }

  std::vector<int> model_row;             ///< m; position in the model of each constraint here
  std::vector<double> fixed_coordinates;  ///< tail of the extended position vector, m
  std::vector<int> block_begin;           ///< free points + 1; point p owns q[dim p .. dim p + dim)
  std::vector<int> block_row;             ///< constraint of each block
  std::vector<Distance> distances;
  std::vector<Dot> others;
  std::vector<Term> other_terms;
  std::vector<Linear> linears;
  std::vector<LinearConstraint::Term> linear_terms;
};

}  // namespace mbs::csc_klu
