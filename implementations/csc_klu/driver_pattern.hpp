// Where driven points and values enter the equations, found once from the model.
#pragma once

#include <array>
#include <vector>

#include "jacobian_pattern.hpp"
#include "mbs/model.hpp"
#include "point_vector.hpp"

namespace mbs::csc_klu {

/// All drivers of a model and what depends on them. Constraints that none of them touches have no
/// Phi_t and are not met here. Derivatives of driven points are found in one vector, `dim` zeros
/// for every point that is not driven, then `dim` numbers for each driven point; those of driven
/// values in another one that begins with one zero.
template <int dim>
struct DriverPattern {
  struct Point {
    int offset;  ///< in extended vectors
    const std::array<TimeFunction, 3>* position;
  };
  struct Value {
    int row;  ///< of Phi, in the order of JacobianPattern
    const TimeFunction* value;
  };
  /// A quadratic constraint whose Phi_t is not zero; a dot constraint has the identity for B.
  struct Row {
    std::array<int, 4> at;     ///< a, b, c, d: offsets into the extended vector
    std::array<int, 4> moved;  ///< the same points: offsets into the derivatives of points
    int value;                 ///< index into the derivatives of values
    SmallMatrix<dim> B;
  };
  /// A Jacobian block of such a constraint.
  struct Term {
    int row;  ///< index into rows
    int block;
    int coordinate;  ///< first one of the block's point
  };
  /// A linear constraint whose Phi_t is not zero.
  struct Linear {
    int begin, end;  ///< its JacobianPattern::linear_terms
    int value;       ///< index into the derivatives of values
  };
  struct Mass {
    int coordinate;
    int acceleration;  ///< offset into the derivatives of points
    double value;      ///< kg
  };

  /// `model` outlives this.
  DriverPattern(const Model& model, const JacobianPattern<dim>& jacobian);

  std::vector<Point> points;
  std::vector<Value> values;
  std::vector<Row> rows;
  std::vector<Term> terms;
  std::vector<Linear> linears;
  std::vector<Mass> masses;

 private:
  /// Finds rows, terms and linears. For every point of the model its offset into the derivatives of
  /// points, for every constraint in the order of JacobianPattern its index into those of values.
  void find_rows(const Model& model, const JacobianPattern<dim>& jacobian,
                 const std::vector<int>& moved, const std::vector<int>& value_of_row);
};

}  // namespace mbs::csc_klu
