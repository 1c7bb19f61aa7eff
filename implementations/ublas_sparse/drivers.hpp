// Driven points, driven values and driven mass, sampled once a step.
#pragma once

#include <array>
#include <vector>

#include "assembly.hpp"
#include "mbs/model.hpp"
#include "points.hpp"

namespace mbs::ublas_sparse {

/// What known functions of time add to Eqs. (3) and (6). Only constraints with a driven point or
/// value are visited.
class Drivers {
 public:
  Drivers(const Model& model, const Points& points);

  [[nodiscard]] bool empty() const { return points_.empty() && values_.empty(); }

  /// Takes all functions at time t (s) and hands positions, velocities and values on.
  void sample(double t, Points& points, Constraints& constraints);
  /// Subtracts the share of driven mass in Q (n, N).
  void subtract_force(Vector& rhs) const;
  /// Adds Phi_t (m, m^2/s).
  void add_rate(const Points& points, Vector& rate) const;
  /// Adds what accelerations of drivers give to the term of Phi'' free of a (m, m^2/s^2).
  void add_acceleration_term(const Points& points, Vector& term) const;

 private:
  struct DrivenCoordinates {
    int first;
    std::array<TimeFunction, 3> position;
  };
  struct Value {
    int row;
    TimeFunction function;
    TimeFunction::Sample sample;
  };
  /// A dot constraint has the identity for B.
  struct Constraint {
    int row, a, b, c, d;
    Matrix3 B;
  };
  struct Mass {
    int coordinate;  // in q
    int driven;      // in acceleration_
    double value;
  };

  void add_constraints(const Model& model, const Points& points);
  /// Adds x_u . B w + u . B x_w, x in the order of Points::position().
  void add_products(const Points& points, const std::vector<double>& x, Vector& sum) const;

  std::vector<DrivenCoordinates> points_;
  std::vector<Value> values_;
  std::vector<Constraint> constraints_;
  std::vector<Mass> masses_;
  // Of driven points alone, zero elsewhere; empty without driven points.
  std::vector<double> velocity_, acceleration_;
};

}  // namespace mbs::ublas_sparse
