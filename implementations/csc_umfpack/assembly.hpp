// The values of M and T on their patterns.
#pragma once

#include <span>
#include <vector>

#include "forces.hpp"
#include "jacobian.hpp"
#include "mbs/model.hpp"
#include "symbolic.hpp"

namespace mbs::csc_umfpack {

/// M, both triangles; positions with a stored zero are entries like any other.
class MassMatrix {
 public:
  explicit MassMatrix(const Model& model);

  [[nodiscard]] const SparsityPattern& pattern() const { return pattern_; }
  [[nodiscard]] std::span<const double> values() const { return values_; }

  /// y = scale (Q - M x).
  void residual(const double* x, const double* Q, double scale, double* y) const;

 private:
  SparsityPattern pattern_;
  std::vector<double> values_;
};

/// T by Eq. (5), both triangles. What does not change is written once, at construction: the entries
/// of M that no block of the schedule covers, and the share of the linear constraints.
template <int D>
class Tangent {
 public:
  /// `factor` is (Delta t^2 / 4) alpha.
  Tangent(const MassMatrix& mass, const JacobianLayout& layout, const ForceLayout& forces,
          double factor);

  [[nodiscard]] const SparsityPattern& pattern() const { return schedule_.pattern; }
  [[nodiscard]] const double* values() const { return values_.data(); }

  void update(const Jacobian<D>& jacobian, const Forces<D>& forces);

 private:
  TangentSchedule<D> schedule_;
  double factor_;
  std::vector<double> values_;
  std::vector<double> constant_;  ///< D x D for every block of the schedule, row by row
};

}  // namespace mbs::csc_umfpack
