// What a model prescribes as a function of time: driven points, driven values, driven mass.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "layout.hpp"
#include "mbs/model.hpp"

namespace mbs::eigen_dense {

/// Samples the drivers of a model once a step and gives their shares in Φ, Q, Φt and Φ̇t.
class Drivers {
 public:
  Drivers(const Model& model, const Layout& layout);

  /// Whether nothing is driven; all other methods are then without effect.
  [[nodiscard]] bool empty() const { return points_.empty() && values_.empty(); }

  /// Takes all values at time t (s) and puts the driven points into the extended q and v.
  void drive(double t, Eigen::VectorXd& q, Eigen::VectorXd& v);

  /// Phi (m) −= the driven values.
  void subtract_values(Eigen::VectorXd& Phi) const;

  /// rhs (n) += factor × the driven mass's part of Q.
  void add_force(double factor, Eigen::VectorXd& rhs) const;

  /// term (m) += Φt at the extended position q.
  void add_velocity_term(const Eigen::VectorXd& q, Eigen::VectorXd& term) const;

  /// term (m) += u_p''·B w + u·B w_p'' − s̈ of Eqs. (7) and (8) at the extended position q.
  void add_acceleration_term(const Eigen::VectorXd& q, Eigen::VectorXd& term) const;

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
    double value;
  };
  /// A constraint with a driven point.
  struct Quadratic {
    Index a, b, c, d;
    Eigen::Matrix3d B;  ///< the unit matrix if it is a dot constraint
    Index row;
  };

  void lower_constraints(const Model& model, const Layout& layout);
  /// term += u_p·B w + u·B w_p with the rates of the driven points in `rates`, extended.
  template <int dimension>
  void add_products(const double* q, const double* rates, double* term) const;
  void add_products(const Eigen::VectorXd& q, const Eigen::VectorXd& rates,
                    Eigen::VectorXd& term) const;

  int dimension_;
  std::vector<MovedPoint> points_;
  std::vector<Value> values_;
  std::vector<Mass> mass_;
  std::vector<Quadratic> quadratics_;
  Eigen::VectorXd velocity_, acceleration_;  ///< extended, zero but at driven points
};

}  // namespace mbs::eigen_dense
