// Where driven points and values enter the equations, found once from the model.
#pragma once

#include <array>
#include <vector>

#include "jacobian_pattern.hpp"
#include "mbs/model.hpp"

namespace mbs::csc_klu {

/// All drivers of a model.
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
  struct Mass {
    int coordinate;
    int acceleration;  ///< offset into the extended accelerations
    double value;      ///< kg
  };

  /// `model` outlives this.
  DriverPattern(const Model& model, const JacobianPattern<dim>& jacobian);

  std::vector<Point> points;
  std::vector<Value> values;
  std::vector<Mass> masses;
};

}  // namespace mbs::csc_klu
