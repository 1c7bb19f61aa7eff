// Phi, Phi_q and the tangent matrix: values refreshed in place on patterns made once.
#pragma once

#include <vector>

#include "coordinates.hpp"
#include "point_pairs.hpp"
#include "rank_update.hpp"
#include "solver.hpp"

namespace mbs::eigen_superlu {

/// Rows of Phi_q are sorted by kind: distances to the ground, distances of free points, other dot
/// constraints by number of free points, bilinear ones likewise, linear constraints. order()[row]
/// is the model's index.
class Assembly {
 public:
  /// `penalty` is (dt^2/4) alpha of Eq. (5). The tangent starts as M plus what the linear
  /// constraints add, which is positive definite, with its final pattern.
  Assembly(const Model& model, const Coordinates& coordinates, Triangle triangle, double penalty);

  /// Phi and the values of Phi_q at `q` (extended, m), Eqs. (7) and (8).
  void evaluate(const Vector& q);
  /// The values of the tangent, Eq. (5) without C and K, from the present Phi_q.
  void refresh_tangent();
  /// Writes (d/dt Phi_q) v to `result` (m), for `v` extended (m/s), Eqs. (7) and (8); what driven
  /// points and values add by their accelerations is not in it.
  void velocity_terms(const Vector& v, Vector& result) const;

  [[nodiscard]] const Vector& phi() const { return phi_; }
  [[nodiscard]] const RowSparseMatrix& jacobian() const { return jacobian_; }
  [[nodiscard]] const SparseMatrix& tangent() const { return tangent_; }
  [[nodiscard]] double* tangent_values() { return tangent_.valuePtr(); }
  /// The constants s of Eqs. (7) and (8) by row (m), for those that are driven.
  [[nodiscard]] Vector& value() { return value_; }
  [[nodiscard]] const std::vector<int>& order() const { return order_; }

 private:
  struct Bilinear {
    PointPairs pairs;
    Matrix B;
  };
  /// Consecutive rows of Phi_q of equal width.
  struct Run {
    AddRows add;
    int first_value, first_slot, count;
  };

  void sort_rows(const Model& model, const Coordinates& coordinates);
  void add_distance(const Coordinates& coordinates, const DotConstraint& constraint);
  void make_jacobian(const Model& model, const Coordinates& coordinates);
  void make_runs(Triangle triangle);
  void add_linear_rows(Triangle triangle);
  template <int kDimension>
  void evaluate_constraints(const double* q);
  template <int kDimension, int kFreeEnds>
  void evaluate_distances(const double* q, int first, int last);
  template <int kDimension>
  void evaluate_velocities(const double* v, double* result) const;

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

  double penalty_;
  SparseMatrix tangent_;
  Vector base_;  // values of the tangent that stay
  std::vector<int> slots_;
  std::vector<Run> runs_;
};

}  // namespace mbs::eigen_superlu
