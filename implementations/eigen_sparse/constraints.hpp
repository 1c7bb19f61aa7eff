// Phi and Phi_q: values refreshed in place on a pattern made once.
#pragma once

#include <vector>

#include "coordinates.hpp"
#include "point_pairs.hpp"

namespace mbs::eigen_sparse {

/// Rows of Phi_q are sorted by kind: distances to the ground, distances of free points, other dot
/// constraints by number of free points, bilinear ones likewise, linear constraints. order()[row]
/// is the model's index.
class Constraints {
 public:
  Constraints(const Model& model, const Coordinates& coordinates);

  /// Phi and the values of Phi_q at `q` (extended, m), Eqs. (7) and (8).
  void evaluate(const Vector& q);
  /// Writes (d/dt Phi_q) v to `result` (m), for `v` extended (m/s), Eqs. (7) and (8); what driven
  /// points and values add by their accelerations is not in it.
  void velocity_terms(const Vector& v, Vector& result) const;
  /// result = Phi_q^T (Phi_q x + y) (n), for x of n entries or more and y (m), in one sweep.
  void multiply_squared(const Vector& x, const Vector& y, Vector& result) const;

  [[nodiscard]] const Vector& phi() const { return phi_; }
  [[nodiscard]] const RowSparseMatrix& jacobian() const { return jacobian_; }
  /// Phi_q (m x n) has rows that change up to here, then those of linear constraints.
  [[nodiscard]] int quadratic() const { return quadratic_; }
  /// The constants s of Eqs. (7) and (8) by row (m), for those that are driven.
  [[nodiscard]] Vector& value() { return value_; }
  [[nodiscard]] const std::vector<int>& order() const { return order_; }

 private:
  struct Bilinear {
    PointPairs pairs;
    Matrix B;
  };

  void sort_rows(const Model& model, const Coordinates& coordinates);
  void add_distance(const Coordinates& coordinates, const DotConstraint& constraint);
  void make_jacobian(const Model& model, const Coordinates& coordinates);
  template <int kDimension>
  void evaluate_constraints(const double* q);
  template <int kDimension, int kFreeEnds>
  void evaluate_distances(const double* q, int first, int last);
  template <int kDimension>
  void evaluate_velocities(const double* v, double* result) const;
  template <int kDimension>
  void add_products(const double* x, const double* y, double* result) const;

  int dimension_;
  int to_ground_ = 0;  // rows [0, to_ground_) are distances to the ground,
  int distances_ = 0;  // rows [to_ground_, distances_) those of free points,
  int products_ = 0;   // rows [distances_, products_) other dot constraints,
  int quadratic_ = 0;  // rows [products_, quadratic_) bilinear ones, then linear ones
  std::vector<int> order_;
  std::vector<int> ends_;  // of distances: coordinates of a (free), then of b
  std::vector<PointPairs> dots_;
  std::vector<Bilinear> bilinear_;
  Vector value_, phi_;
  RowSparseMatrix jacobian_;
};

}  // namespace mbs::eigen_sparse
