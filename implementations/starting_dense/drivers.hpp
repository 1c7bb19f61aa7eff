// What is prescribed: driven points, driven values, and the mass that couples to them.
#pragma once

#include <vector>

#include "layout.hpp"
#include "matrix.hpp"
#include "mbs/model.hpp"

namespace mbs::starting_dense {

/// Samples the model's functions of time. With n variables, m constraints and d coordinates of
/// driven points.
///
///   if (!drivers.empty()) drivers.sample(t, q, v, values, Q);  // once a step
class Drivers {
 public:
  /// `model` outlives the drivers.
  Drivers(const Model& model, const Layout& layout);

  /// Whether nothing depends on time: then no other member is needed.
  [[nodiscard]] bool empty() const { return positions_.empty() && values_.empty(); }

  /// Evaluates everything at time t (s), and writes the position and velocity of driven points to
  /// `q` and `v` (extended), driven s to `values` (m), and Q (n) where a driven mass changes it.
  void sample(double t, Vector& q, Vector& v, Vector& values, Vector& Q);

  /// r_p'' of the last sample (d).
  [[nodiscard]] const Vector& acceleration() const { return acceleration_; }
  /// result (m) -= s'; the other -= s'', of the last sample.
  void subtract_rates(Vector& result) const;
  void subtract_accelerations(Vector& result) const;

 private:
  struct Value {
    int constraint;
    const TimeFunction* function;
    TimeFunction::Sample sample;
  };
  struct Mass {
    int coordinate;
    int driver;    ///< index into acceleration_
    double value;  ///< kg
    double force;  ///< N, the constant part of Q at the coordinate
  };

  const int variables_;
  std::vector<const TimeFunction*> positions_;  ///< d
  std::vector<Value> values_;
  std::vector<Mass> masses_;
  Vector acceleration_;
};

}  // namespace mbs::starting_dense
