// What a model prescribes as a function of time: driven points, driven values, driven mass.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "layout.hpp"
#include "mbs/model.hpp"

namespace mbs::eigen_dense {

/// Samples the drivers of a model once a step and gives their shares in Φ, Q, Φt and Φ̇t.
template <typename Scalar>
class Drivers {
 public:
  using Vector = Eigen::VectorX<Scalar>;

  Drivers(const Model& model, const Layout& layout);

  /// Whether nothing is driven; all other methods are then without effect.
  [[nodiscard]] bool empty() const { return points_.empty() && values_.empty(); }

  /// Takes all values at time t (s) and puts the driven points into the extended q and v.
  void drive(double t, Vector& q, Vector& v);

  /// Phi (m) −= the driven values. The two terms are from now on those at the extended position q.
  void evaluate(const Vector& q, Vector& Phi);

  /// rhs (n) += factor × the driven mass's part of Q.
  void add_force(Scalar factor, Vector& rhs) const;

  /// term (m) += Φt.
  void add_velocity_term(Vector& term) const;

  /// term (m) += u_p''·B w + u·B w_p'' − s̈ of Eqs. (7) and (8).
  void add_acceleration_term(Vector& term) const;

 private:
  using Index = Eigen::Index;

  struct MovedPoint {
    Index start;
    std::array<TimeFunction, 3> position;
  };
  struct Value {
    Index row;
    TimeFunction function;
    TimeFunction::Sample now;
  };
  struct Mass {
    Index coordinate;
    Index source;  ///< where the acceleration is, in an extended vector
    Scalar value;
  };
  /// A constraint with a driven point.
  struct Quadratic {
    Index a, b, c, d;
    Eigen::Matrix<Scalar, 3, 3> B;  ///< the unit matrix if it is a dot constraint
    Index row;
  };

  void lower_constraints(const Model& model, const Layout& layout);
  /// term += u_p·B w + u·B w_p with the rates of the driven points in `rates`, extended.
  template <int dimension>
  void add_products(const Scalar* rates, Scalar* term) const;
  void add_products(const Vector& rates, Vector& term) const;

  int dimension_;
  std::vector<MovedPoint> points_;
  std::vector<Value> values_;
  std::vector<Mass> mass_;
  std::vector<Quadratic> quadratics_;
  Vector velocity_, acceleration_;  ///< extended, zero but at driven points
  Vector q_;                        ///< extended, of the last evaluate(); empty without such points
};

}  // namespace mbs::eigen_dense
