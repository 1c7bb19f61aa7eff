// Points and values that are known functions of time.
#pragma once

#include <vector>

#include "coordinates.hpp"
#include "point_pairs.hpp"

namespace mbs::eigen_sparse {

/// What drives a model, sampled once a step, and what follows from it in Phi and Q.
class Drivers {
 public:
  /// `order`: the model's constraint in each row of Phi.
  Drivers(const Model& model, const Coordinates& coordinates, const std::vector<int>& order);

  /// Takes the values at time `t` (s) and writes those that others read: position and velocity of
  /// driven points into the tails of `q` and `v` (extended), driven values into `value` (m), the
  /// driven masses' share into `force` (n, N).
  void sample(double t, Vector& q, Vector& v, Vector& value, Vector& force);

  /// Takes `q` (extended): the two below tell what is there.
  void evaluate(const Vector& q);
  /// Adds Phi_t, Eqs. (7) and (8), to `result` (m).
  void add_rates(Vector& result) const;
  /// Adds what accelerations of drivers contribute to d/dt (Phi_q) v + d/dt Phi_t.
  void add_accelerations(Vector& result) const;

 private:
  struct Coordinate {
    int at;  // in extended vectors
    TimeFunction position;
  };
  struct Value {
    int row;
    TimeFunction value;
    double rate = 0.0, acceleration = 0.0;
  };
  /// A quadratic constraint with a driven point; B is the identity for a dot constraint.
  struct Row {
    int row;
    PointPairs pairs;
    Matrix B;
    double rate = 0.0, acceleration = 0.0;  // what its points contribute
  };
  struct Mass {
    int at, point;        // the unknown, and the driven coordinate in extended vectors
    double value, force;  // kg; the constant force at the unknown (N)
  };

  void add_rows(const Model& model, const Coordinates& coordinates, const std::vector<int>& order);
  template <int kDimension>
  void evaluate_rows(const Vector& q);

  int dimension_;
  std::vector<Coordinate> coordinates_;
  std::vector<Value> values_;
  std::vector<Row> rows_;
  std::vector<Mass> masses_;
  Vector velocity_, acceleration_;  // extended; zero but for driven points
};

}  // namespace mbs::eigen_sparse
