// What is prescribed by functions of time.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "jacobian.hpp"
#include "layout.hpp"
#include "mbs/model.hpp"

namespace mbs::csc_umfpack {

/// Driven points, values and masses of a Model, which must outlive it. Times t are in s.
template <int D>
class Drivers {
 public:
  Drivers(const Model& model, const PointLayout& points, const JacobianLayout& layout);

  [[nodiscard]] bool empty() const { return points_.empty() && values_.empty(); }

  /// Positions, velocities and accelerations of the driven points at t, into x, v and a.
  void move(double t, double* x, double* v, double* a) const;
  /// Driven values of the constraints at t; keeps their derivatives.
  void set_values(double t, Jacobian<D>& jacobian);
  /// Q (n) of gravity and driven masses, where there are any, with accelerations of move().
  void set_force(const double* a, double* Q) const;
  /// y (m) -= first or second derivatives of the driven values, Eqs. (7) and (8).
  void subtract_rates(double* y) const;
  void subtract_second_rates(double* y) const;

 private:
  struct Point {
    int offset = 0;  ///< in x
    std::array<TimeFunction, 3> position;
  };
  struct Value {
    int row = 0;  ///< of the layout
    TimeFunction function;
    TimeFunction::Sample sample;
  };
  struct Mass {
    int coordinate = 0;
    int driven = 0;  ///< the driven coordinate, in x
    double value = 0.0;
  };

  std::span<const double> gravity_;  ///< n, N
  std::vector<Point> points_;
  std::vector<Value> values_;
  std::vector<Mass> masses_;
};

}  // namespace mbs::csc_umfpack
