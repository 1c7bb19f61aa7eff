// What is prescribed by functions of time, sampled once a step, and what it adds to Eqs. (6), (7).
#pragma once

#include <array>
#include <span>
#include <vector>

#include "jacobian.hpp"
#include "layout.hpp"
#include "mbs/model.hpp"
#include "vectors.hpp"

namespace mbs::csc_umfpack {

/// Driven points, values and masses of a Model, which must outlive it. Only the rows that they
/// reach are looked at.
template <int D>
class Drivers {
 public:
  Drivers(const Model& model, const PointLayout& points, const JacobianLayout& layout);

  [[nodiscard]] bool empty() const { return points_.empty() && values_.empty(); }

  /// Takes all values at time t (s), for the following.
  void sample(double t);
  /// Positions and velocities of the driven points, into x and v.
  void move(double* x, double* v) const;
  /// Driven values of the constraints.
  void set_values(Jacobian<D>& jacobian) const;
  /// Q (n) of gravity and driven masses, where there are any.
  void set_force(double* Q) const;
  /// y (m) += factor Phi_t at x.
  void add_rates(const double* x, double factor, double* y) const;
  /// y (m) += factor times what driven accelerations give of the second derivative of Phi at x.
  void add_accelerations(const double* x, double factor, double* y) const;

 private:
  struct Point {
    int offset = 0;  ///< in x
    std::array<TimeFunction, 3> position;
  };
  struct Value {
    int row = 0;  ///< of the layout
    TimeFunction function;
  };
  struct Mass {
    int coordinate = 0;
    int slot = 0;  ///< in a Sample's points
    double value = 0.0;
  };
  /// A constraint with driven points or a driven value.
  struct Row {
    int row = 0;                  ///< of the layout
    std::array<int, 4> points{};  ///< a, b, c, d as offsets into x
    std::array<int, 4> slots{};   ///< the same as offsets into a Sample's points
    Matrix B{};
    int value = 0;  ///< index into a Sample's values
  };
  /// What was sampled, or its first or second derivative: a zero for all that is not driven, then
  /// points_ (D numbers each) and values_ in their order.
  struct Sample {
    std::vector<double> points, values;
  };

  void add_rows(const Model& model, const PointLayout& points, const JacobianLayout& layout);
  /// u_p . B w + u . B w_p - s at x with u_p, w_p and s of a derivative, Eq. (7).
  static double term(const Row& row, const double* x, const Sample& derivative);

  std::span<const double> gravity_;  ///< n, N
  std::vector<Point> points_;
  std::vector<Value> values_;
  std::vector<Mass> masses_;
  std::vector<Row> rows_;
  Sample now_, first_, second_;
};

}  // namespace mbs::csc_umfpack
