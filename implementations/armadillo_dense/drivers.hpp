// Driven points and values: their samples at t', and what they add to Phi_t, its derivative and Q.
#pragma once

#include <armadillo>
#include <array>
#include <vector>

#include "layout.hpp"
#include "mbs/model.hpp"

namespace mbs::armadillo_dense {

/// Samples what is prescribed once a step; the samples hold until the next. A model without drivers
/// has empty lists here and no storage.
class Drivers {
 public:
  Drivers(const Model& model, const Layout& layout);

  [[nodiscard]] bool empty() const { return points_.empty() && values_.empty(); }

  /// Takes all values at time t (s): into extended positions x and velocities v, and the constraint
  /// values s (m).
  void sample(double t, arma::vec& x, arma::vec& v, arma::vec& values);
  /// Sets h Q at the coordinates that driven masses act on.
  void load(double h, arma::vec& scaled_Q) const;

  /// out (m) += Phi_t at extended positions x.
  void add_rates(const arma::vec& x, arma::vec& out) const;
  /// out += the terms of driven accelerations in the derivative of Phi_q v + Phi_t.
  void add_accelerations(const arma::vec& x, arma::vec& out) const;

 private:
  struct DrivenPlace {
    int start;  ///< in extended vectors
    std::array<TimeFunction, 3> position;
  };
  struct DrivenRow {
    int row;
    TimeFunction value;
    TimeFunction::Sample sample;
  };
  /// A dot (B = I) or bilinear constraint on a driven point.
  struct Product {
    int row;
    int a, b, c, d;  ///< of the points, in extended vectors
    std::array<std::array<double, 3>, 3> B;
  };
  struct Mass {
    int coordinate;
    int start;        ///< of the driven acceleration, in extended vectors
    double value;     ///< kg
    double constant;  ///< N, the constant part of Q at the coordinate
  };

  void lower_points(const Model& model);
  void lower_products(const Model& model);
  /// out += u_p·B w + u·B w_p, where u_p and w_p are differences of `driven`.
  void add_products(const arma::vec& x, const arma::vec& driven, arma::vec& out) const;

  const Layout& layout_;
  std::vector<DrivenPlace> points_;
  std::vector<DrivenRow> values_;
  std::vector<Product> products_;
  std::vector<Mass> masses_;
  arma::vec rates_, accelerations_;  ///< extended, of driven points; zero elsewhere
};

}  // namespace mbs::armadillo_dense
