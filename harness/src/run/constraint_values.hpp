// Phi of one model, evaluated again and again.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "mbs/model.hpp"

namespace mbs {

/// What evaluate_constraints() gives. Of a model that has dot constraints alone, and no drivers,
/// from a list of what they need: names and drivers of points between the numbers take longer than
/// the numbers.
///
///   ConstraintValues values(model);
///   values.evaluate(t, q, phi);
class ConstraintValues {
 public:
  /// `model` must outlive this.
  explicit ConstraintValues(const Model& model);

  /// `phi`: constraints().
  void evaluate(double t, std::span<const double> q, std::span<double> phi) const;

 private:
  struct Row {
    std::array<int, 4> points{};  // a, b, c, d: first coordinate in q, or -1 - that in fixed_
    double value = 0.0;           // m^2
    bool is_distance = false;
  };
  template <bool kSpatial>
  void evaluate_rows(const double* q, double* phi) const;

  const Model* model_;  // a pointer, so that judges can be copied
  std::vector<Row> rows_;
  std::vector<double> fixed_;  // coordinates of fixed points, m
};

}  // namespace mbs
