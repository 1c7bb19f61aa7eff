// Driven points and values: their samples at t', and their share of Q.
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

  /// Takes all values at time t (s): into extended positions x, velocities v and accelerations a,
  /// and the constraint values s (m).
  void sample(double t, arma::vec& x, arma::vec& v, arma::vec& a, arma::vec& values);
  /// Sets h Q at the coordinates that driven masses act on, with extended accelerations a.
  void load(double h, const arma::vec& a, arma::vec& scaled_Q) const;

  /// out (m) -= the first, or second, derivative of the values s.
  void subtract_rates(arma::vec& out) const;
  void subtract_accelerations(arma::vec& out) const;

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
  struct Mass {
    int coordinate;
    int start;        ///< of the driven acceleration, in extended vectors
    double value;     ///< kg
    double constant;  ///< N, the constant part of Q at the coordinate
  };

  int dimension_;
  std::vector<DrivenPlace> points_;
  std::vector<DrivenRow> values_;
  std::vector<Mass> masses_;
};

}  // namespace mbs::armadillo_dense
